// SPDX-License-Identifier: MIT
// Pinhole, thin-lens and orthographic cameras of the reference.
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

/// Pinhole, thin-lens or orthographic camera. In camera space it looks along -z, with +y up and +x
/// to the right.
class Camera {
  public:
    /// Creates camera `index` of the store with a film of `width` x `height` square pixels. Throws
    /// `Error` (bad input) for an index out of range, a film without pixels, a field of view
    /// outside (0, pi), or an invalid size, aperture radius or focus distance.
    Camera(const CameraArrays &cameras, size_t index, int width, int height);

    /// Returns the ray through the centre of the lens and the film point (x, y). The film point is
    /// in pixels from the top left corner: x in [0, width] to the right, y in [0, height]
    /// downwards. If (x, y) is uniform in a pixel, the importance of the ray is 1 (box filter). The
    /// ray of an orthographic camera begins on its film.
    Ray ray(double x, double y) const {
        if (!axis_.isZero()) {
            return {position_ + corner_ + x * step_x_ + y * step_y_, axis_};
        }
        return {position_, (corner_ + x * step_x_ + y * step_y_).normalized()};
    }

    /// Returns a ray from a uniform point of the lens to the point where `ray(x, y)` meets the
    /// plane of focus. Its importance is 1 as well: the pixel value is the mean over film and lens,
    /// as for a pinhole of the same exposure (PBRT 4th ed., section 5.2.3). A pinhole draws no
    /// random numbers.
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
    Vec3 corner_;  ///< top left corner of the film at distance 1, relative to the position
    Vec3 step_x_;  ///< one pixel to the right
    Vec3 step_y_;  ///< one pixel down
    Vec3 lens_x_;  ///< lens radius to the right; zero for a pinhole
    Vec3 lens_y_;  ///< lens radius upwards
    double focus_distance_;
    Vec3 axis_;  ///< direction of all rays of an orthographic camera; otherwise zero
};

}  // namespace rtrays::reference
