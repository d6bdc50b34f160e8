// SPDX-License-Identifier: MIT
#pragma once

#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A ray in double precision; `direction` has unit length.
struct Ray {
    Vec3 origin;
    Vec3 direction;
};

/// Pinhole camera looking along -z, +y up, +x right in camera space.
class Camera {
  public:
    /// Camera `index` of the store with a film of `width` x `height` square pixels. Throws `Error` (bad
    /// input) for an index out of range, a film without pixels or an angle of view outside (0, pi).
    Camera(const CameraArrays &cameras, size_t index, int width, int height);

    /// The ray through (x, y) in pixels from the top left corner of the film: x in [0, width] to the
    /// right, y in [0, height] downwards. With (x, y) uniform in a pixel its importance is 1 (box filter).
    Ray ray(double x, double y) const {
        return {position_, (corner_ + x * step_x_ + y * step_y_).normalized()};
    }

  private:
    Vec3 position_;
    Vec3 corner_;  ///< of the film at distance 1, relative to the position: top left
    Vec3 step_x_;  ///< one pixel to the right
    Vec3 step_y_;  ///< one pixel down
};

}  // namespace rtrays::reference
