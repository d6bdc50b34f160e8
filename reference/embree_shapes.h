// SPDX-License-Identifier: MIT
// Queries of an Embree scene: shapes as user geometry, and surfaces that let rays pass. Embree
// traverses in float; the callbacks use double.
#pragma once

#include <embree3/rtcore.h>

#include <vector>

#include "reference/shape.h"

namespace rtrays::reference {

/// Geometry ID of all shapes. The primitive ID is the index of the shape.
constexpr unsigned shapes_id = 1;

class Geometry;

/// Context of every query. It passes the ray in double to the callbacks and returns the hit point
/// on a shape.
struct SceneQuery : RTCIntersectContext {
    SceneQuery(const Geometry &of, const Ray &wanted, uint64_t key_of_ray, bool coherent)
        : geometry(&of), ray(&wanted), key(key_of_ray) {
        rtcInitIntersectContext(this);
        flags =
            coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }

    /// Finds the nearest hit with shape `index` at t in (0, t_max) that stops the ray.
    bool meets_shape(uint32_t index, double t_max, double &t, Vec3 &at) const;

    const Geometry *geometry;
    const Ray *ray;
    uint64_t key;  ///< decides whether surfaces that are not opaque stop the ray
    Vec3 object;   ///< point in object space on the nearest shape hit so far
};

/// Lets rays pass the triangles of a geometry that are not opaque.
void attach_opacity(RTCGeometry triangles);

/// Attaches the bounded shapes to the scene. The vector must outlive the scene and must not move.
void attach_shapes(RTCDevice device, RTCScene scene, std::vector<Shape> &shapes);

}  // namespace rtrays::reference
