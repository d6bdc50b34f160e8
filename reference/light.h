// SPDX-License-Identifier: MIT
// Emission and its sampling. A light kind is one alternative of the variant in `LightSet` with the members
//
//     std::optional<LightSample> sample(geometry, from, rng)   a point of the light, given that it was chosen
//     double pdf_w(geometry, from, hit)   the density of `sample` for that direction, 0 for delta lights
//     Spectrum emitted(geometry, hit, wo) radiance leaving the hit point towards wo
//     double power()                      W, mean of the channels: drives selection
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "reference/geometry.h"
#include "reference/math.h"
#include "reference/rng.h"
#include "reference/sampling.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A direction in which to look for light.
struct LightSample {
    Vec3 wi;            ///< unit, from the shaded point towards the light
    Vec3 target;        ///< end of the shadow segment, off the light's own surface
    Spectrum radiance;  ///< arriving from there when nothing is in between
    double pdf_w;       ///< per solid angle at the shaded point, selection included
    bool delta;         ///< cannot be hit by chance: no MIS partner
};

/// One-sided diffuse emission from all triangles of a mesh; points are uniform in area (pdf_a = 1 / area).
class DiffuseAreaLight {
  public:
    /// `triangles`: indices into the geometry, at least one.
    DiffuseAreaLight(const Geometry &geometry, std::vector<uint32_t> triangles, const Spectrum &radiance);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    double pdf_w(const Geometry &geometry, const Vec3 &from, const SurfacePoint &hit) const;
    Spectrum emitted(const Geometry &geometry, const SurfacePoint &hit, const Vec3 &wo) const;
    double power() const { return pi * area_ * radiance_.mean(); }  ///< thesis 3.3.4: pi A Le

  private:
    std::vector<uint32_t> triangles_;
    AliasTable choose_;  ///< in proportion to area
    double area_;
    Spectrum radiance_;
};

/// All lights and the choice among them: half by power, half uniform, so that no light is ever chosen less
/// often than 1 / (2 N).
class LightSet {
  public:
    LightSet(const Geometry &geometry, const LightArrays &lights);

    bool empty() const { return lights_.empty(); }

    /// A point on one chosen light; nothing when it faces away.
    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;

    /// Density with which `sample` chooses the direction from `from` to `hit`, a point on light `light`.
    double pdf_w(const Geometry &geometry, uint32_t light, const Vec3 &from, const SurfacePoint &hit) const;

    /// Radiance leaving `hit`, a point on light `light`, towards `wo`.
    Spectrum emitted(const Geometry &geometry, uint32_t light, const SurfacePoint &hit, const Vec3 &wo) const;

  private:
    std::vector<std::variant<DiffuseAreaLight>> lights_;
    std::vector<uint32_t> slot_;  ///< position in `lights_` of each light of the store, or `no_index`
    AliasTable choose_;
};

}  // namespace rtrays::reference
