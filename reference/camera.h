// SPDX-License-Identifier: MIT
#pragma once

#include "reference/math.h"
#include "reference/rng.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A ray in double precision; `direction` has unit length.
struct Ray {
    Vec3 origin;
    Vec3 direction;
};

/// Pinhole or thin-lens camera looking along -z, +y up, +x right in camera space.
class Camera {
  public:
    /// Camera `index` of the store with a film of `width` x `height` square pixels. Throws `Error`
    /// (bad input) for an index out of range, a film without pixels or an angle of view outside (0,
    /// pi).
    Camera(const CameraArrays &cameras, size_t index, int width, int height);

    /// The ray through the middle of the lens and (x, y) in pixels from the top left corner of the
    /// film: x in [0, width] to the right, y in [0, height] downwards. With (x, y) uniform in a
    /// pixel its importance is 1 (box filter).
    Ray ray(double x, double y) const {
        return {position_, (corner_ + x * step_x_ + y * step_y_).normalized()};
    }

    /// A ray from a uniform point of the lens to where `ray(x, y)` meets the plane of focus. Its
    /// importance is 1 as well: the pixel's value is the mean over film and lens, as for a pinhole
    /// of the same exposure (PBRT 4th ed., 5.2.3). Draws nothing for a pinhole.
    Ray ray(double x, double y, Rng &rng) const {
        if (lens_x_.isZero()) {
            return ray(x, y);
        }
        const double radius = std::sqrt(rng.uniform());
        const double phi = 2.0 * pi * rng.uniform();
        const Vec3 on_lens = radius * (std::cos(phi) * lens_x_ + std::sin(phi) * lens_y_);
        const Vec3 focus = focus_distance_ * (corner_ + x * step_x_ + y * step_y_);
        return {position_ + on_lens, (focus - on_lens).normalized()};
    }

  private:
    Vec3 position_;
    Vec3 corner_;  ///< of the film at distance 1, relative to the position: top left
    Vec3 step_x_;  ///< one pixel to the right
    Vec3 step_y_;  ///< one pixel down
    Vec3 lens_x_;  ///< radius of the lens to the right; zero for a pinhole
    Vec3 lens_y_;  ///< upwards
    double focus_distance_;
};

}  // namespace rtrays::reference
