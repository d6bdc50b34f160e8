// SPDX-License-Identifier: MIT
#include "renderer/import/scene_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>
#include <vector>

#include "embedded/scene_schemas.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/import/triangulate.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// A scene whose centre is more than this many times its size away from the origin is moved there before it
/// is rounded to float: by then four bits of every coordinate would be lost to the distance.
constexpr double far_away = 16;

/// An error that already says where.
struct LocatedError : Error {
    explicit LocatedError(const std::string &message) : Error(ExitCode::bad_input, message) {}
};

Eigen::Vector3d vector3(const Json &value) {
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

/// Builds the graph from a document that the schema has accepted; what a schema cannot say is checked here.
class SceneReader {
  public:
    SceneReader(const Json &document, const std::string &text, const std::string &source_name, Scene &scene)
        : document_(document), text_(text), source_name_(source_name), scene_(scene) {}

    void read() {
        const Json &film = document_.at("film");
        scene_.set_film_size(film.at("width"), film.at("height"));
        for (const auto &entry : section("materials").items()) {
            const std::string path = "/materials/" + entry.key();
            located(path, [&] { materials_[entry.key()] = material(entry.value(), entry.key()); });
            scene_.graph().share("materials." + entry.key(), materials_[entry.key()]);
        }
        for (const auto &entry : section("geometries").items()) {
            const std::string path = "/geometries/" + entry.key();
            geometries_[entry.key()] = geometry(entry.value(), entry.key(), path);
            scene_.graph().share("geometries." + entry.key(), geometries_[entry.key()]);
        }
        read_nodes(document_.at("nodes"), "/nodes", scene_.graph().root());
    }

    /// Writes the arrays and checks the scene as a whole.
    void finish() {
        located("", [&] {
            scene_.update(0);
            const Eigen::AlignedBox3d bounds = scene_.graph().bounds();
            const bool has_geometry = !bounds.isEmpty();
            if (has_geometry && bounds.center().norm() > far_away * 0.5 * bounds.diagonal().norm()) {
                scene_.graph().set_origin(bounds.center());
                scene_.update(0);
            }
            const std::vector<std::string> &cameras = scene_.cameras().name;
            if (cameras.empty()) {
                throw input_error("the scene has no camera; add a node with a \"camera\"");
            }
            if (document_.contains("camera")) {
                scene_.set_active_camera(document_.at("camera"));
            } else if (cameras.size() > 1) {
                throw input_error(fmt::format("the scene has several cameras; choose one by \"camera\": {}",
                                              fmt::join(cameras, ", ")));
            }
        });
    }

  private:
    const Json &section(const char *name) const {
        static const Json empty = Json::object();
        return document_.contains(name) ? document_.at(name) : empty;
    }

    /// Runs `body`; an `Error` from it gets source, line and path, the innermost one that is known.
    template <typename Body>
    std::invoke_result_t<Body> located(const std::string &path, const Body &body) const {
        try {
            return body();
        } catch (const LocatedError &) {
            throw;
        } catch (const Error &error) {
            throw LocatedError(fmt::format("{}: {}", json_location(source_name_, text_, path), error.what()));
        }
    }

    template <typename Map>
    typename Map::mapped_type reference(const Map &shared, const std::string &name, const char *what) const {
        const auto found = shared.find(name);
        if (found == shared.end()) {
            std::vector<std::string> names;
            for (const auto &entry : shared) {
                names.push_back(entry.first);
            }
            throw input_error(
                fmt::format("no {} '{}'; there are: {}", what, name,
                            names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
        }
        return found->second;
    }

    static std::shared_ptr<MaterialCore> material(const Json &value, const std::string &name) {
        return std::make_shared<LambertMaterial>(name, vector3(value.at("reflectance")));
    }

    std::shared_ptr<MeshCore> geometry(const Json &value, const std::string &name,
                                       const std::string &path) const {
        std::vector<Eigen::Vector3d> vertices;
        for (const Json &vertex : value.at("vertices")) {
            vertices.push_back(vector3(vertex));
        }
        std::vector<Triangle> triangles;
        const Json &polygons = value.at("polygons");
        for (size_t i = 0; i < polygons.size(); ++i) {
            const auto corners = polygons[i].get<std::vector<uint64_t>>();
            located(fmt::format("{}/polygons/{}", path, i), [&] {
                std::vector<uint32_t> indices;
                for (const uint64_t corner : corners) {
                    if (corner >= vertices.size()) {
                        throw input_error(
                            fmt::format("mesh '{}': polygon {} has vertex {}, but there are only {} vertices",
                                        name, i, corner, vertices.size()));
                    }
                    indices.push_back(static_cast<uint32_t>(corner));
                }
                try {
                    const std::vector<Triangle> parts = triangulate(vertices, indices);
                    triangles.insert(triangles.end(), parts.begin(), parts.end());
                } catch (const Error &error) {
                    throw input_error(fmt::format("mesh '{}': polygon {} {}", name, i, error.what()));
                }
            });
        }
        return located(path, [&] {
            return std::make_shared<MeshCore>(name, std::move(vertices), std::move(triangles));
        });
    }

    static Eigen::Matrix4d operation(const Json &value) {
        const std::string name = value.begin().key();
        const Json &argument = value.begin().value();
        if (name == "translate") {
            return translation(vector3(argument));
        }
        if (name == "scale") {
            return scaling(vector3(argument));
        }
        if (name == "rotate") {
            return rotation(vector3(argument.at("axis")), argument.at("degrees").get<double>() * degree);
        }
        if (name == "look_at") {
            return look_at(vector3(argument.at("origin")), vector3(argument.at("target")),
                           vector3(argument.at("up")));
        }
        Eigen::Matrix4d matrix;  // the schema leaves no other operation
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                matrix(row, column) = argument[row][column];
            }
        }
        return matrix;
    }

    std::shared_ptr<TransformCore> transform(const Json &operations, const std::string &name,
                                             const std::string &path) const {
        Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
        for (size_t i = 0; i < operations.size(); ++i) {
            located(fmt::format("{}/{}", path, i), [&] {
                // Each by itself, so that the message names the one at fault.
                const TransformCore checked(name, operation(operations[i]));
                matrix = checked.matrix() * matrix;
            });
        }
        return located(path, [&] { return std::make_shared<TransformCore>(name, matrix); });
    }

    void read_nodes(const Json &nodes, const std::string &path, Node &parent) {
        for (size_t i = 0; i < nodes.size(); ++i) {
            read_node(nodes[i], fmt::format("{}/{}", path, i), parent);
        }
    }

    void read_node(const Json &value, const std::string &path, Node &parent) {
        const std::string name = value.at("name");
        Node &node = *located(path + "/name", [&] {
            if (name.find('.') != std::string::npos) {
                throw input_error(fmt::format(
                    "'{}': a name must not contain a dot, which separates it from its properties", name));
            }
            return &parent.add_child(std::make_unique<Node>(name));
        });
        const auto with = [&](const char *key, const auto &build) {
            if (value.contains(key)) {
                const std::string at = path + "/" + key;
                node.set_core(
                    located(at, [&]() -> std::shared_ptr<Core> { return build(value.at(key), at); }));
            }
        };
        // Every node gets these two, so that each can be moved and hidden by name.
        const Json operations = value.value("transform", Json::array());
        node.set_core(transform(operations, name, path + "/transform"));
        node.set_core(std::make_shared<VisibilityCore>(name, value.value("visible", true)));
        with("material", [&](const Json &v, const std::string &) {
            return v.is_string() ? reference(materials_, v.get<std::string>(), "material")
                                 : material(v, name);
        });
        with("geometry", [&](const Json &v, const std::string &at) {
            return v.is_string() ? reference(geometries_, v.get<std::string>(), "geometry")
                                 : geometry(v, name, at);
        });
        with("light", [&](const Json &v, const std::string &) {
            return std::make_shared<DiffuseAreaLight>(name, vector3(v.at("radiance")));
        });
        with("camera", [&](const Json &v, const std::string &) {
            return std::make_shared<PinholeCamera>(name, v.at("fov").get<double>(),
                                                   parse_fov_axis(v.at("fov_axis")));
        });
        if (value.contains("children")) {
            read_nodes(value.at("children"), path + "/children", node);
        }
    }

    const Json &document_;
    const std::string &text_;
    const std::string &source_name_;
    Scene &scene_;
    std::map<std::string, std::shared_ptr<MaterialCore>> materials_;
    std::map<std::string, std::shared_ptr<MeshCore>> geometries_;
};

}  // namespace

Scene parse_scene_json(const std::string &text, const std::string &source_name,
                       const std::string &default_name) {
    const Json document = parse_json(text, source_name);
    validate_json(document, std::string(embedded::scene_schemas().text("scene.schema.json")), source_name,
                  text);
    Scene scene;
    scene.set_name(document.value("name", default_name));
    SceneReader reader(document, text, source_name, scene);
    reader.read();
    reader.finish();
    return scene;
}

}  // namespace rtrays
