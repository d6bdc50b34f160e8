// SPDX-License-Identifier: MIT
// Lights that have a surface: one-sided diffuse emission of constant radiance. Each has the members
//
//     std::optional<LightSample> sample(geometry, from, rng)   a point of the light, given that it
//     was chosen double pdf_w(geometry, from, hit)   the density of `sample` for that direction,
//     per solid angle Spectrum emitted(geometry, hit, wo) radiance leaving the hit point towards wo
//     double power()                      W, mean of the channels (thesis 3.3.4: pi A Le)
#pragma once

#include <optional>
#include <vector>

#include "reference/geometry.h"
#include "reference/light_sample.h"
#include "reference/math.h"
#include "reference/rng.h"
#include "reference/sampling.h"

namespace rtrays::reference {

/// What all diffuse area lights share: density per area 1 / area, emission from the front.
class DiffuseEmitter {
  public:
    DiffuseEmitter(double area, const Spectrum &radiance) : area_(area), radiance_(radiance) {}

    double pdf_w(const Geometry &geometry, const Vec3 &from, const SurfacePoint &hit) const;
    Spectrum emitted(const Geometry &geometry, const SurfacePoint &hit, const Vec3 &wo) const {
        return geometry.normal(hit).dot(wo) > 0.0 ? radiance_ : Spectrum::Zero();
    }
    double power() const { return pi * area_ * radiance_.mean(); }

  protected:
    /// Looking from `from` at a point that was drawn uniformly in area; nothing from behind.
    std::optional<LightSample> look(const Geometry &geometry, const Vec3 &from,
                                    const SurfacePoint &point, const Vec3 &normal) const;

    double area_;
    Spectrum radiance_;
};

/// All triangles of a mesh; points are uniform in area.
class MeshLight : public DiffuseEmitter {
  public:
    /// `triangles`: indices into the geometry, at least one.
    MeshLight(const Geometry &geometry, std::vector<uint32_t> triangles, const Spectrum &radiance);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;

  private:
    std::vector<uint32_t> triangles_;
    AliasTable choose_;  ///< in proportion to area
};

/// A disc, or the ellipse that an affine map makes of it; points are uniform in area, which such a
/// map preserves.
class DiscLight : public DiffuseEmitter {
  public:
    /// `shape`: index of the geometry's shape.
    DiscLight(const Geometry &geometry, uint32_t shape, const Spectrum &radiance);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;

  private:
    uint32_t shape_;
    Vec3 normal_;
};

/// A sphere under a similarity, emitting outwards; directions are uniform in the cone it fills as
/// seen from outside (Shirley, Wang & Zimmerman 1996, 3.2).
class SphereLight : public DiffuseEmitter {
  public:
    /// `shape`: index of the geometry's shape. Throws `Error` (bad input) when it is no sphere.
    SphereLight(const Geometry &geometry, uint32_t shape, const Spectrum &radiance);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    double pdf_w(const Geometry &geometry, const Vec3 &from, const SurfacePoint &hit) const;

  private:
    Vec3 centre_;
    double radius_;
    double offset_;  ///< of shadow rays' ends from the surface
};

}  // namespace rtrays::reference
