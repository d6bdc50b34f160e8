// SPDX-License-Identifier: MIT
#include "renderer/import/json/scene_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "embedded/scene_schemas.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/base/suggestion.h"
#include "renderer/import/json/geometry.h"
#include "renderer/import/json/material.h"
#include "renderer/import/json/transform.h"
#include "renderer/import/json/values.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

/// Builds the graph from a document that the schema has accepted. Checks the constraints that a
/// schema cannot express.
class SceneReader {
  public:
    SceneReader(const Json &document, SceneSource source, const SceneJsonOptions &options,
                Scene &scene)
        : document_(document), source_(std::move(source)), options_(options), scene_(scene) {}

    void read() {
        const Json &film = document_.at("film");
        scene_.set_film_size(film.at("width"), film.at("height"));
        if (film.contains("crop")) {
            const Json &crop = film.at("crop");
            source_.located("/film/crop", [&] {
                scene_.set_crop({crop.at("x"), crop.at("y"), crop.at("width"), crop.at("height")});
            });
        }
        read_section("textures", textures_,
                     [this](const Json &value, const std::string &name, const std::string &path) {
                         return read_texture(value, name, source_, path, files_);
                     });
        read_section("materials", materials_,
                     [this](const Json &value, const std::string &name, const std::string &path) {
                         return material(value, name, path);
                     });
        read_section("geometries", geometries_,
                     [this](const Json &value, const std::string &name, const std::string &path) {
                         return read_geometry(value, name, source_, path);
                     });
        read_nodes(document_.at("nodes"), "/nodes", scene_.graph().root());
    }

    /// Updates the arrays and checks the full scene.
    void finish() {
        source_.located("", [&] {
            scene_.update(0);
            scene_.recentre();
            const std::vector<std::string> &cameras = scene_.cameras().name;
            if (document_.contains("camera")) {
                scene_.set_active_camera(document_.at("camera"));
            } else if (own_cameras_.size() == 1) {
                scene_.set_active_camera(own_cameras_.front());
            } else if (!options_.is_part && cameras.empty()) {
                throw input_error("the scene has no camera; add a node with a \"camera\"");
            } else if (!options_.is_part && cameras.size() > 1) {
                throw input_error(
                    fmt::format("the scene has several cameras; select one by \"camera\": {}",
                                fmt::join(cameras, ", ")));
            }
        });
    }

  private:
    /// Reads the named objects of a section of the document, which nodes may share.
    template <typename Map, typename Read>
    void read_section(const std::string &section, Map &shared, const Read &read) {
        if (!document_.contains(section)) {
            return;
        }
        for (const auto &entry : document_.at(section).items()) {
            const std::string path = "/" + section + "/" + entry.key();
            shared[entry.key()] = read(entry.value(), entry.key(), path);
            scene_.graph().share(section + "." + entry.key(), shared[entry.key()]);
        }
    }

    template <typename Map>
    typename Map::mapped_type reference(const Map &shared, const std::string &name,
                                        const char *what) const {
        const auto found = shared.find(name);
        if (found == shared.end()) {
            std::vector<std::string> names;
            for (const auto &entry : shared) {
                names.push_back(entry.first);
            }
            throw input_error(fmt::format(
                "unknown {} '{}'; {}the scene defines: {}", what, name, suggestion(name, names),
                names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
        }
        return found->second;
    }

    std::shared_ptr<MaterialCore> material(const Json &value, const std::string &name,
                                           const std::string &path) {
        const auto lookup = [this](const Json &texture, const std::string &texture_name,
                                   const std::string &at) {
            return texture.is_string()
                       ? source_.located(at,
                                         [&] { return reference(textures_, texture, "texture"); })
                       : read_texture(texture, texture_name, source_, at, files_);
        };
        return read_material(value, name, source_, path, lookup);
    }

    std::shared_ptr<LightCore> light(const Json &value, const std::string &name,
                                     const std::string &path) {
        const LightType &type = find_type(light_types(), value.at("type"), "light");
        if (type.kind != LightArrays::Kind::environment) {
            return std::make_shared<LightCore>(
                name, type.name,
                parameter_values(value, type.name, type.parameters, {}, source_, path));
        }
        check_keys(value, type.name, {"file"}, {"scale"});
        const ParameterValues values =
            parameter_values(value, type.name, type.parameters, {"file"}, source_, path);
        return source_.located(path + "/file", [&] {
            return std::make_shared<LightCore>(
                name, files_.load(source_.file(value.at("file")), TextureEncoding::linear), values);
        });
    }

    std::shared_ptr<CameraCore> camera(const Json &value, const std::string &name,
                                       const std::string &path) {
        const CoreType &type = find_type(camera_types(), value.at("type"), "camera");
        return std::make_shared<CameraCore>(
            name, type.name,
            parameter_values(value, type.name, type.parameters, {}, source_, path));
    }

    void read_nodes(const Json &nodes, const std::string &path, Node &parent) {
        for (size_t i = 0; i < nodes.size(); ++i) {
            read_node(nodes[i], fmt::format("{}/{}", path, i), parent);
        }
    }

    void read_node(const Json &value, const std::string &path, Node &parent) {
        const std::string name = value.at("name");
        Node &node = *source_.located(path + "/name", [&] {
            if (name.find('.') != std::string::npos) {
                throw input_error(fmt::format(
                    "'{}': a name must not contain a dot, which separates it from its properties",
                    name));
            }
            return &parent.add_child(std::make_unique<Node>(name));
        });
        const auto with = [&](const char *key, const auto &build) {
            if (value.contains(key)) {
                const std::string at = path + "/" + key;
                node.set_core(source_.located(
                    at, [&]() -> std::shared_ptr<Core> { return build(value.at(key), at); }));
            }
        };
        // Every node has a transform and a visibility, so that settings can move and hide it.
        node.set_core(read_transform(value, name, source_, path));
        node.set_core(std::make_shared<VisibilityCore>(name, value.value("visible", true)));
        with("material", [&](const Json &v, const std::string &at) {
            return v.is_string() ? reference(materials_, v, "material") : material(v, name, at);
        });
        with("geometry", [&](const Json &v, const std::string &at) {
            return v.is_string() ? reference(geometries_, v, "geometry")
                                 : read_geometry(v, name, source_, at);
        });
        with("light", [&](const Json &v, const std::string &at) { return light(v, name, at); });
        with("camera", [&](const Json &v, const std::string &at) {
            own_cameras_.push_back(name);
            return camera(v, name, at);
        });
        if (value.contains("import")) {
            read_import(value, path, node);
        }
        if (value.contains("children")) {
            read_nodes(value.at("children"), path + "/children", node);
        }
    }

    /// Puts all nodes and shared objects of another scene below a node.
    void read_import(const Json &value, const std::string &path, Node &node) {
        Scene part = source_.located(path + "/import", [&] {
            if (!options_.load_import) {
                throw input_error("imports are not supported here");
            }
            return options_.load_import(source_.file(value.at("import")));
        });
        set_properties(part, value, path, source_);
        source_.located(path, [&] { scene_.graph().absorb(part.graph(), node); });
    }

    const Json &document_;
    SceneSource source_;
    const SceneJsonOptions &options_;
    Scene &scene_;
    std::vector<std::string> own_cameras_;  ///< of this file, not of imports
    TextureFiles files_;
    std::map<std::string, std::shared_ptr<Texture>> textures_;
    std::map<std::string, std::shared_ptr<MaterialCore>> materials_;
    std::map<std::string, std::shared_ptr<Core>> geometries_;
};

}  // namespace

Scene parse_scene_json(const std::string &text, const std::string &source_name,
                       const std::string &default_name, const std::filesystem::path &directory,
                       const SceneJsonOptions &options) {
    const Json document = parse_json(text, source_name);
    validate_json(document, std::string(embedded::scene_schemas().text("scene.schema.json")),
                  source_name, text);
    Scene scene;
    scene.set_name(document.value("name", default_name));
    SceneReader reader(document, {text, source_name, directory}, options, scene);
    reader.read();
    reader.finish();
    return scene;
}

}  // namespace rtrays
