// SPDX-License-Identifier: MIT
#include "renderer/scene/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/json.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

/// Whether the bytes of a vector of T are those of its numbers one after the other: numbers, arrays
/// of numbers, and matrices of fixed size.
template <typename T>
struct is_plain : std::bool_constant<std::is_arithmetic_v<T> || std::is_enum_v<T>> {};
template <typename T, size_t n>
struct is_plain<std::array<T, n>> : is_plain<T> {};
template <typename T, int rows, int columns>
struct is_plain<Eigen::Matrix<T, rows, columns>>
    : std::bool_constant<sizeof(Eigen::Matrix<T, rows, columns>) == sizeof(T) * rows * columns> {};

/// Collects the bytes of values and arrays, each array with its length.
class ByteCollector {
  public:
    template <typename T>
    void add(const T &value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "padding must not be hashed");
        bytes_.append(reinterpret_cast<const char *>(&value), sizeof(value));
    }
    template <typename T>
    void add(const std::vector<T> &values) {
        add(static_cast<uint64_t>(values.size()));
        if constexpr (is_plain<T>::value) {
            bytes_.append(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T));
        } else {
            for (const T &value : values) {
                add(value);
            }
        }
    }
    template <typename T, size_t n>
    void add(const std::array<T, n> &values) {
        for (const T &value : values) {
            add(value);
        }
    }
    template <typename T, int rows, int columns>
    void add(const Eigen::Matrix<T, rows, columns> &matrix) {
        for (Eigen::Index i = 0; i < matrix.size(); ++i) {
            add(matrix.data()[i]);
        }
    }
    void add(const BxdfComponent &component) {
        add(component.kind);
        add(component.weight);
        add(component.texture);
        add(component.fresnel);
        add(component.complement);
        add(component.fresnel_of_wo);
        add(component.eta);
        add(component.k);
        add(component.sigma);
        add(component.exponent);
        add(component.alpha);
        add(component.distribution);
    }
    void add(const TextureImage &image) {
        add(image.width);
        add(image.height);
        add(image.srgb);
        add(image.bytes);
        add(image.floats);
    }
    /// Begins a section that is present only in some scenes.
    void begin(const std::string &name) { bytes_ += name; }
    const std::string &bytes() const { return bytes_; }

  private:
    std::string bytes_ = "rtrays scene 2";
};

/// Adds the sections that are present only in some scenes, so that the hashes of other scenes do
/// not change when scenes gain a feature.
void add_sections(const SceneArrays &arrays, ByteCollector &collector) {
    const MeshArrays &meshes = arrays.meshes;
    if (!meshes.normal.empty() || !meshes.uv.empty()) {
        collector.begin("interpolated");
        collector.add(meshes.has_normals);
        collector.add(meshes.has_uv);
    }
    const TextureArrays &textures = arrays.textures;
    if (!textures.image.empty()) {
        collector.begin("textures");
        for (const auto &image : textures.image) {
            collector.add(*image);
        }
        collector.add(textures.filter);
        collector.add(textures.wrap);
        collector.add(textures.uv_scale);
        collector.add(textures.uv_offset);
    }
    if (std::any_of(textures.vertex_colours.begin(), textures.vertex_colours.end(),
                    [](uint8_t has) { return has != 0; })) {
        collector.begin("vertex colours");
        collector.add(textures.vertex_colours);
        collector.add(meshes.colour);
    }
    const std::vector<MaterialOpacity> &opacities = arrays.materials.opacity;
    if (!std::all_of(opacities.begin(), opacities.end(),
                     [](const MaterialOpacity &opacity) { return opacity.is_opaque(); })) {
        collector.begin("opacity");
        for (const MaterialOpacity &opacity : opacities) {
            collector.add(opacity.value);
            collector.add(opacity.texture);
            collector.add(opacity.cutoff);
        }
    }
    const std::vector<NormalMap> &maps = arrays.materials.normal_map;
    if (!std::all_of(maps.begin(), maps.end(),
                     [](const NormalMap &map) { return map.kind == NormalMap::Kind::none; })) {
        collector.begin("normal_maps");
        for (const NormalMap &map : maps) {
            collector.add(map.kind);
            collector.add(map.texture);
            collector.add(map.scale);
            collector.add(map.shadowing);
            collector.add(map.follows_v);
            collector.add(map.mirrored_back);
        }
    }
    const std::vector<uint32_t> &emissions = arrays.materials.emission_texture;
    if (std::any_of(emissions.begin(), emissions.end(),
                    [](uint32_t texture) { return texture != no_index; })) {
        collector.begin("emission textures");
        collector.add(emissions);
    }
    const std::vector<BxdfComponent> &components = arrays.materials.component;
    if (std::any_of(components.begin(), components.end(), [](const BxdfComponent &component) {
            return component.side != BxdfComponent::Side::both;
        })) {
        collector.begin("sides");
        for (const BxdfComponent &component : components) {
            collector.add(component.side);
        }
    }
    if (std::any_of(components.begin(), components.end(), [](const BxdfComponent &component) {
            return component.kind == BxdfComponent::Kind::coated_lambert;
        })) {
        collector.begin("coats");
        for (const BxdfComponent &component : components) {
            collector.add(component.nonlinear);
            collector.add(component.inner_reflectance);
        }
    }
    if (std::any_of(components.begin(), components.end(), [](const BxdfComponent &component) {
            return component.kind == BxdfComponent::Kind::disney_diffuse;
        })) {
        collector.begin("disney");
        for (const BxdfComponent &component : components) {
            collector.add(component.disney_roughness);
            collector.add(component.flatness);
        }
    }
    if (std::any_of(components.begin(), components.end(), [](const BxdfComponent &component) {
            return component.roughness_texture != no_index;
        })) {
        collector.begin("roughness_textures");
        for (const BxdfComponent &component : components) {
            collector.add(component.roughness_texture);
            collector.add(component.roughness_squared);
        }
    }
    if (std::any_of(components.begin(), components.end(), [](const BxdfComponent &component) {
            return component.mix_texture != no_index;
        })) {
        collector.begin("mixtures");
        for (const BxdfComponent &component : components) {
            collector.add(component.mix_texture);
            collector.add(component.mix);
            collector.add(component.mix_inverted);
        }
    }
    const ShapeArrays &shapes = arrays.shapes;
    if (!shapes.kind.empty()) {
        collector.begin("shapes");
        collector.add(shapes.kind);
        collector.add(shapes.world_from_object);
        collector.add(shapes.material);
        collector.add(shapes.light);
        collector.add(shapes.flare);
        collector.add(shapes.julia_constant);
        collector.add(shapes.julia_slice);
        collector.add(shapes.julia_iterations);
    }
    const LightArrays &lights = arrays.lights;
    if (std::any_of(lights.mesh.begin(), lights.mesh.end(),
                    [](uint32_t mesh) { return mesh == no_index; })) {
        collector.begin("lights");
        collector.add(lights.shape);
        collector.add(lights.world_from_light);
        collector.add(lights.inner_angle);
        collector.add(lights.outer_angle);
        for (const auto &image : lights.image) {
            collector.add(image != nullptr);
            if (image != nullptr) {
                collector.add(*image);
            }
        }
    }
}

}  // namespace

Scene::Scene() : graph_(std::make_unique<SceneGraph>()) {}
Scene::~Scene() = default;
Scene::Scene(Scene &&) noexcept = default;
Scene &Scene::operator=(Scene &&) noexcept = default;

void Scene::set_film_size(int width, int height) {
    constexpr int largest = 1 << 16;
    if (width < 1 || height < 1 || width > largest || height > largest) {
        throw input_error(
            fmt::format("film: {} x {} pixels are out of range; each side must be from 1 to {}",
                        width, height, largest));
    }
    film_width_ = width;
    film_height_ = height;
    crop_.reset();
}

void Scene::set_crop(const FilmCrop &crop) {
    const auto fits = [](int first, int size, int all) {
        return first >= 0 && size >= 1 && size <= all && first <= all - size;
    };
    if (!fits(crop.x, crop.width, film_width_) || !fits(crop.y, crop.height, film_height_)) {
        throw input_error(fmt::format(
            "crop: the window of {} x {} pixels at ({}, {}) is not in the film of {} x {}",
            crop.width, crop.height, crop.x, crop.y, film_width_, film_height_));
    }
    crop_ = crop;
}

void Scene::set_property(const std::string &address, const std::string &text) {
    graph_->set_property(address, text);
}

std::string Scene::describe() const {
    std::string properties;
    graph_->visit_properties(
        [&](const std::string &owner, const Property &property) {
            properties += fmt::format("{}.{} = {}  # {}: {}\n", owner, property.name,
                                      property.text(), property.type(), property.help);
        },
        [&](const std::string &node, const std::string &shared) {
            properties += fmt::format("{} uses {}\n", node, shared);
        });
    return fmt::format(
        "scene '{}': {} triangles in {} meshes, {} shapes, {} materials, {} textures, {} lights, "
        "{} cameras, film {} x {}\n{}",
        name_, meshes().triangle.size(), meshes().name.size(), arrays().shapes.name.size(),
        materials().name.size(), arrays().textures.name.size(), lights().name.size(),
        cameras().name.size(), film_width_, film_height_, properties);
}

std::string Scene::describe_json() const {
    Json properties = Json::array(), uses = Json::array();
    graph_->visit_properties(
        [&](const std::string &owner, const Property &property) {
            properties.push_back({{"address", owner + "." + property.name},
                                  {"value", property.text()},
                                  {"type", property_type(property.get())},
                                  {"choices", property.choices},
                                  {"read_only", property.set == nullptr},
                                  {"help", property.help}});
        },
        [&](const std::string &node, const std::string &shared) {
            uses.push_back({{"node", node}, {"object", shared}});
        });
    const Json document = {{"name", name_},
                           {"film", {film_width_, film_height_}},
                           {"triangles", meshes().triangle.size()},
                           {"meshes", meshes().name.size()},
                           {"shapes", arrays().shapes.name.size()},
                           {"materials", materials().name.size()},
                           {"textures", arrays().textures.name.size()},
                           {"lights", lights().name.size()},
                           {"cameras", cameras().name},
                           {"properties", properties},
                           {"uses", uses}};
    return document.dump(2) + "\n";
}

void Scene::update(double time) {
    graph_->update(time);
}

const SceneArrays &Scene::arrays() const {
    return graph_->arrays();
}

SceneRevision Scene::revision() const {
    return graph_->revision();
}

int Scene::active_camera() const {
    const std::vector<std::string> &names = cameras().name;
    if (names.empty()) {
        throw input_error(fmt::format("scene '{}' has no camera; add one", name_));
    }
    const auto found =
        camera_node_.empty() ? names.begin() : std::find(names.begin(), names.end(), camera_node_);
    if (found == names.end()) {
        throw input_error(fmt::format("scene '{}': unknown camera '{}'; cameras are: {}", name_,
                                      camera_node_, fmt::join(names, ", ")));
    }
    return static_cast<int>(found - names.begin());
}

void Scene::set_active_camera(const std::string &node_name) {
    const std::string previous = std::exchange(camera_node_, node_name);
    try {
        active_camera();
    } catch (const Error &) {
        camera_node_ = previous;
        throw;
    }
}

void Scene::recentre() {
    // Distance of the centre as a multiple of the scene's radius. At this distance every coordinate
    // has lost four bits.
    constexpr double far_away = 16;
    const Eigen::AlignedBox3d bounds = graph_->bounds();
    if (!bounds.isEmpty() && bounds.center().norm() > far_away * 0.5 * bounds.diagonal().norm()) {
        graph_->set_origin(bounds.center());
        graph_->update(graph_->time());
    }
}

Eigen::Vector3d Scene::origin() const {
    return graph_->origin();
}

std::string Scene::hash() const {
    const auto camera = static_cast<size_t>(active_camera());
    ByteCollector collector;
    collector.add(cameras().world_from_camera[camera]);
    collector.add(cameras().fov[camera]);
    collector.add(cameras().fov_axis[camera]);
    collector.add(cameras().aperture_radius[camera]);
    collector.add(cameras().focus_distance[camera]);
    collector.add(materials().first_component);
    collector.add(materials().component_count);
    collector.add(materials().two_sided);
    for (const BxdfComponent &component : materials().component) {
        collector.add(component);
    }
    collector.add(meshes().first_triangle);
    collector.add(meshes().triangle_count);
    collector.add(meshes().material);
    collector.add(meshes().light);
    collector.add(meshes().position);
    collector.add(meshes().normal);
    collector.add(meshes().uv);
    collector.add(meshes().triangle);
    collector.add(lights().kind);
    collector.add(lights().radiance);
    collector.add(lights().mesh);
    if (cameras().is_orthographic(camera)) {
        collector.begin("orthographic");
        collector.add(cameras().view_size[camera]);
    }
    add_sections(arrays(), collector);
    return content_hash(collector.bytes());
}

}  // namespace rtrays
