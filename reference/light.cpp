// SPDX-License-Identifier: MIT
#include "reference/light.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

using Kind = LightArrays::Kind;

constexpr double uniform_share = 0.5;  ///< share of the selection probability; the rest is by power

/// Returns half the diagonal of the bounded surfaces. For light selection, this is the radius of
/// what parallel light can fall on.
double scene_radius(const Geometry &geometry) {
    return geometry.bounds().isEmpty() ? 1.0 : 0.5 * geometry.bounds().diagonal().norm();
}

/// Returns the material of the surface of an area light.
uint32_t material_of(const Geometry &geometry, const LightArrays &lights, size_t light) {
    if (lights.shape[light] != no_index) {
        return geometry.shapes()[lights.shape[light]].material();
    }
    const auto &triangles = geometry.triangles();
    return std::find_if(triangles.begin(), triangles.end(),
                        [&](const TriangleRecord &t) { return t.light == light; })
        ->material;  // a mesh light has a triangle
}

/// Multiplies the radiance of an area light by a texture, if there is one.
template <class Light>
void set_texture(const std::optional<Texture> &texture, Light &light) {
    if (!texture) {
        return;
    }
    std::visit(
        [&](auto &one) {
            if constexpr (std::is_base_of_v<DiffuseEmitter, std::decay_t<decltype(one)>>) {
                one.set_texture(*texture);
            }
        },
        light);
}

}  // namespace

std::optional<LightSet::Light> LightSet::make_light(const Geometry &geometry,
                                                    const LightArrays &lights, size_t i,
                                                    std::vector<uint32_t> triangles) {
    const Spectrum radiance = lights.radiance[i].cast<double>();
    const Eigen::Matrix3d rotation = lights.world_from_light[i].topLeftCorner<3, 3>();
    const Vec3 position = lights.world_from_light[i].topRightCorner<3, 1>();
    const Vec3 axis = -rotation.col(2);
    switch (lights.kind[i]) {
        case Kind::diffuse_area: {
            if (lights.shape[i] == no_index) {
                // A mesh without area emits nothing.
                return triangles.empty() ? std::nullopt
                                         : std::optional<Light>(
                                               MeshLight(geometry, std::move(triangles), radiance));
            }
            if (lights.shape[i] >= geometry.shapes().size()) {
                throw input_error("the shape does not exist");
            }
            const ShapeArrays::Kind shape = geometry.shapes()[lights.shape[i]].kind();
            if (shape == ShapeArrays::Kind::sphere) {
                return SphereLight(geometry, lights.shape[i], radiance);
            }
            if (shape == ShapeArrays::Kind::disc) {
                return DiscLight(geometry, lights.shape[i], radiance);
            }
            throw input_error("only meshes, discs and spheres can emit light");
        }
        case Kind::point:
            return PointLight(position, radiance);
        case Kind::spot:
            if (!(lights.inner_angle[i] >= 0.0 && lights.inner_angle[i] < lights.outer_angle[i] &&
                  lights.outer_angle[i] <= 0.5 * pi + 1e-9)) {
                throw input_error(
                    "the angles of a spot light must satisfy 0 <= inner < outer <= pi / 2");
            }
            return SpotLight(position, axis, lights.inner_angle[i], lights.outer_angle[i],
                             radiance);
        case Kind::directional:
            return DirectionalLight(axis, radiance, scene_radius(geometry));
        case Kind::dome:
            return DomeLight(radiance, scene_radius(geometry));
        case Kind::environment:
            return EnvironmentLight(lights.image[i], rotation, radiance, scene_radius(geometry),
                                    "environment map");
    }
    throw run_error("unknown light kind");
}

std::vector<std::optional<Texture>> emission_textures(const MaterialArrays &materials,
                                                      const TextureArrays &textures) {
    std::vector<std::optional<Texture>> all(materials.emission_texture.size());
    bool any = false;
    for (size_t i = 0; i < all.size(); ++i) {
        if (materials.emission_texture[i] != no_index) {
            all[i].emplace(textures, materials.emission_texture[i]);
            any = true;
        }
    }
    return any ? all : std::vector<std::optional<Texture>>();
}

LightSet::LightSet(const Geometry &geometry, const LightArrays &lights,
                   const std::vector<std::optional<Texture>> &textures) {
    std::vector<std::vector<uint32_t>> triangles(lights.kind.size());
    for (uint32_t i = 0; i < geometry.triangles().size(); ++i) {
        const uint32_t light = geometry.triangles()[i].light;
        if (light != no_index) {
            triangles.at(light).push_back(i);
        }
    }
    std::vector<double> powers;
    for (size_t i = 0; i < lights.kind.size(); ++i) {
        const auto fail = [&](const std::string &complaint) {
            throw input_error(fmt::format("light {} '{}': {}", i, lights.name[i], complaint));
        };
        if (!(lights.radiance[i].array() >= 0.0f).all() || !lights.radiance[i].allFinite()) {
            fail("radiance must be finite and not negative");
        }
        std::optional<Light> light;
        try {
            light = make_light(geometry, lights, i, std::move(triangles[i]));
        } catch (const Error &error) {
            fail(error.what());
        }
        if (light && !textures.empty() && lights.kind[i] == Kind::diffuse_area) {
            set_texture(textures.at(material_of(geometry, lights, i)), *light);
        }
        slot_.push_back(light ? static_cast<uint32_t>(lights_.size()) : no_index);
        if (!light) {
            continue;
        }
        if (lights.kind[i] == Kind::dome || lights.kind[i] == Kind::environment) {
            infinite_.push_back(slot_.back());
        }
        lights_.push_back(std::move(*light));
        powers.push_back(std::visit([](const auto &l) { return l.power(); }, lights_.back()));
    }
    if (lights_.empty()) {
        return;
    }
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    std::vector<double> weights;
    for (const double power : powers) {
        const double uniform = 1.0 / static_cast<double>(powers.size());
        weights.push_back(total > 0.0
                              ? uniform_share * uniform + (1.0 - uniform_share) * power / total
                              : uniform);
    }
    choose_ = AliasTable(weights);
}

std::optional<LightSample> LightSet::sample(const Geometry &geometry, const Vec3 &from,
                                            Rng &rng) const {
    const uint32_t chosen = choose_.sample(rng);
    auto sample = std::visit([&](const auto &light) { return light.sample(geometry, from, rng); },
                             lights_[chosen]);
    if (sample) {
        sample->pdf_w *= choose_.probability(chosen);
    }
    return sample;
}

double LightSet::pdf_w(const Geometry &geometry, uint32_t light, const Vec3 &from,
                       const SurfacePoint &hit) const {
    const uint32_t slot = slot_[light];
    return choose_.probability(slot) *
           std::visit([&](const auto &l) { return l.pdf_w(geometry, from, hit); }, lights_[slot]);
}

Spectrum LightSet::emitted(const Geometry &geometry, uint32_t light, const SurfacePoint &hit,
                           const Vec3 &wo) const {
    return std::visit([&](const auto &l) { return l.emitted(geometry, hit, wo); },
                      lights_[slot_[light]]);
}

}  // namespace rtrays::reference
