// SPDX-License-Identifier: MIT
// Shapes as user geometry of an Embree scene. Embree traverses in float; the callbacks intersect in
// double.
#pragma once

#include <embree3/rtcore.h>

#include <vector>

#include "reference/shape.h"

namespace rtrays::reference {

constexpr unsigned shapes_id =
    1;  ///< geometry ID of all shapes; the primitive ID is the shape's index

/// Must be the context of every query of a scene that holds shapes: the ray in double goes to the
/// callbacks in it and the hit comes back.
struct ShapeQuery : RTCIntersectContext {
    ShapeQuery(const Ray &wanted, bool coherent) : ray(&wanted) {
        rtcInitIntersectContext(this);
        flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
    const Ray *ray;
    Vec3 object;  ///< of the nearest shape hit so far
};

/// Unbounded shapes are left out. The vector must outlive the scene and not move.
void attach_shapes(RTCDevice device, RTCScene scene, std::vector<Shape> &shapes);

}  // namespace rtrays::reference
