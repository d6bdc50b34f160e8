// SPDX-License-Identifier: MIT
// Shapes as user geometry of an Embree scene. Embree traverses in float; the callbacks use double.
#pragma once

#include <embree3/rtcore.h>

#include <vector>

#include "reference/shape.h"

namespace rtrays::reference {

/// Geometry ID of all shapes. The primitive ID is the index of the shape.
constexpr unsigned shapes_id = 1;

/// Context of every query of a scene with shapes. It passes the ray in double to the callbacks and
/// returns the hit point.
struct ShapeQuery : RTCIntersectContext {
    ShapeQuery(const Ray &wanted, bool coherent) : ray(&wanted) {
        rtcInitIntersectContext(this);
        flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
    const Ray *ray;
    Vec3 object;  ///< point in object space on the nearest shape hit so far
};

/// Attaches the bounded shapes to the scene. The vector must outlive the scene and must not move.
void attach_shapes(RTCDevice device, RTCScene scene, std::vector<Shape> &shapes);

}  // namespace rtrays::reference
