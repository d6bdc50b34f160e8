// SPDX-License-Identifier: MIT
// Area lights: meshes, discs and spheres with one-sided diffuse emission, constant or by a texture.
// Every area light has these members:
//
//     std::optional<LightSample> sample(geometry, from, rng)
//         Samples a point on the light, given that this light was selected.
//     double pdf_w(geometry, from, hit)
//         Density with which `sample` chooses the direction to `hit`, per solid angle at `from`.
//     Spectrum emitted(geometry, hit, wo)
//         Radiance leaving `hit` towards `wo`.
//     double power()
//         Emitted power pi A Le [W], mean of the channels (thesis, section 3.3.4). With a texture,
//         an estimate by the mean of its texels, which affects noise only.
#pragma once

#include <optional>
#include <vector>

#include "reference/geometry.h"
#include "reference/light_sample.h"
#include "reference/math.h"
#include "reference/rng.h"
#include "reference/sampling.h"
#include "reference/texture.h"

namespace rtrays::reference {

/// Base of the area lights. Only the front emits. `pdf_w` is for points that are uniform in area
/// (density 1 / area).
class DiffuseEmitter {
  public:
    DiffuseEmitter(double area, const Spectrum &radiance) : area_(area), radiance_(radiance) {}

    /// Multiplies the radiance by a texture.
    void set_texture(const Texture &texture) { texture_ = texture; }

    double pdf_w(const Geometry &geometry, const Vec3 &from, const SurfacePoint &hit) const;
    Spectrum emitted(const Geometry &geometry, const SurfacePoint &hit, const Vec3 &wo) const {
        return geometry.normal(hit).dot(wo) > 0.0 ? radiance_at(geometry, hit)
                                                  : Spectrum(Spectrum::Zero());
    }
    double power() const {
        return pi * area_ * (texture_ ? Spectrum(radiance_ * texture_->mean()) : radiance_).mean();
    }

  protected:
    Spectrum radiance_at(const Geometry &geometry, const SurfacePoint &point) const {
        return texture_ ? Spectrum(radiance_ * texture_->evaluate(geometry.parametrize(point).uv))
                        : radiance_;
    }

    /// Builds the light sample for `point`, which was sampled uniformly in area, as seen from
    /// `from`. Returns nothing if `from` is behind the light.
    std::optional<LightSample> look(const Geometry &geometry, const Vec3 &from,
                                    const SurfacePoint &point, const Vec3 &normal) const;

    double area_;
    Spectrum radiance_;
    std::optional<Texture> texture_;
};

/// All triangles of a mesh. Points are uniform in area.
class MeshLight : public DiffuseEmitter {
  public:
    /// `triangles`: indices into the geometry's triangles, at least one.
    MeshLight(const Geometry &geometry, std::vector<uint32_t> triangles, const Spectrum &radiance);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;

  private:
    std::vector<uint32_t> triangles_;
    AliasTable choose_;  ///< selects a triangle in proportion to its area
};

/// A disc, or the ellipse that an affine map makes of it. Points are uniform in area, because an
/// affine map preserves uniformity.
class DiscLight : public DiffuseEmitter {
  public:
    /// `shape`: index of the geometry's shape.
    DiscLight(const Geometry &geometry, uint32_t shape, const Spectrum &radiance);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;

  private:
    uint32_t shape_;
    Vec3 normal_;
};

/// A sphere under a similarity transform, emitting outwards. Directions are uniform in the cone
/// that the sphere subtends from outside (Shirley, Wang & Zimmerman 1996, section 3.2).
class SphereLight : public DiffuseEmitter {
  public:
    /// `shape`: index of the geometry's shape. Throws `Error` (bad input) if its transform is not a
    /// similarity.
    SphereLight(const Geometry &geometry, uint32_t shape, const Spectrum &radiance);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    double pdf_w(const Geometry &geometry, const Vec3 &from, const SurfacePoint &hit) const;

  private:
    uint32_t shape_;
    Vec3 centre_;
    double radius_;
    double offset_;  ///< distance of the ends of shadow rays from the surface
};

}  // namespace rtrays::reference
