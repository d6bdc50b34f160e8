// SPDX-License-Identifier: MIT
// All lights of a scene and the selection among them. Each type of light is one alternative of the
// variant `Light` (area_light.h, delta_light.h, infinite_light.h).
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "reference/area_light.h"
#include "reference/delta_light.h"
#include "reference/geometry.h"
#include "reference/infinite_light.h"
#include "reference/light_sample.h"
#include "reference/math.h"
#include "reference/rng.h"
#include "reference/sampling.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// All lights of a scene. The selection probability is half by power and half uniform, so that no
/// light of N is ever selected with a probability below 1 / (2 N).
class LightSet {
  public:
    /// Throws `Error` (bad input) naming the light for parameters out of range. `textures` has the
    /// texture of each material's emission, or nothing if no material has one.
    LightSet(const Geometry &geometry, const LightArrays &lights,
             const std::vector<std::optional<Texture>> &textures = {});

    bool empty() const { return lights_.empty(); }
    bool reach_to_infinity() const { return !infinite_.empty(); }

    /// Samples a direction towards one selected light. Returns nothing if that light does not
    /// illuminate `from`.
    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;

    /// Returns the density, per solid angle, with which `sample` chooses the direction from `from`
    /// to `hit`, a point on light `light`.
    double pdf_w(const Geometry &geometry, uint32_t light, const Vec3 &from,
                 const SurfacePoint &hit) const;

    /// Returns the radiance leaving `hit`, a point on light `light`, towards `wo`.
    Spectrum emitted(const Geometry &geometry, uint32_t light, const SurfacePoint &hit,
                     const Vec3 &wo) const;

    /// Returns the weighted radiance arriving from infinity: the sum of radiance times
    /// weight(pdf_w) over the lights there. `pdf_w` is the density with which `sample` chooses the
    /// direction through that light.
    template <class Weight>
    Spectrum from_infinity(const Vec3 &direction, const Weight &weight) const {
        Spectrum total = Spectrum::Zero();
        for (const uint32_t slot : infinite_) {
            const auto add = [&](const auto &light) {
                const Spectrum radiance = light.radiance(direction);
                if ((radiance > 0.0).any()) {
                    total += radiance * weight(choose_.probability(slot) * light.pdf_w(direction));
                }
            };
            if (const auto *dome = std::get_if<DomeLight>(&lights_[slot])) {
                add(*dome);
            } else {
                add(std::get<EnvironmentLight>(lights_[slot]));
            }
        }
        return total;
    }

  private:
    using Light = std::variant<MeshLight, DiscLight, SphereLight, PointLight, SpotLight,
                               DirectionalLight, DomeLight, EnvironmentLight>;
    static std::optional<Light> make_light(const Geometry &geometry, const LightArrays &lights,
                                           size_t i, std::vector<uint32_t> triangles);

    std::vector<Light> lights_;
    /// Index into `lights_` of each light of the store, or `no_index`.
    std::vector<uint32_t> slot_;
    /// Indices into `lights_` of the lights at infinity that a path can hit.
    std::vector<uint32_t> infinite_;
    AliasTable choose_;
};

/// Returns the texture of each material's emission, or nothing if no material has one. Throws
/// `Error` (bad input) like `Texture`.
std::vector<std::optional<Texture>> emission_textures(const MaterialArrays &materials,
                                                      const TextureArrays &textures);

}  // namespace rtrays::reference
