// SPDX-License-Identifier: MIT
// The point of a triangle that a ray hit, with a bound of its error, and origins for rays that
// leave it.
//
// Source: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th ed., section 6.8.
// Departure: PBRT moves the origin by the error of the point alone, and rejects hits nearer than a
// per-hit bound on t. That leaks at concave edges of large triangles. Here the offset also covers
// the error of the next triangle test, so no hit is rejected.
#pragma once

#include "renderer/shared/compat.h"

/// A point on a surface.
typedef struct SurfacePoint {
    float3 position;  ///< recomputed from the barycentrics
    float3 normal;    ///< geometric, unit length, (v1 - v0) x (v2 - v0)
    /// Bound of the position's distance from the triangle as the triangle test sees it, per axis.
    float3 error;
} SurfacePoint;

/// Returns the triangle's size E: the largest difference of a coordinate along the edges from v0.
DEVICE float triangle_extent(float3 v0, float3 v1, float3 v2) {
    const float3 largest = max(fabs(v1 - v0), fabs(v2 - v0));
    return max(largest.x, max(largest.y, largest.z));
}

/// Returns the unit geometric normal. It is zero if the rounded edges are parallel, which the BVH
/// builder rejects as degenerate. Edges are scaled first, so no product overflows or underflows
/// between 1e-30 and 1e30.
DEVICE float3 triangle_normal(float3 v0, float3 v1, float3 v2) {
    const float3 e1 = v1 - v0;
    const float3 e2 = v2 - v0;
    const float extent = triangle_extent(v0, v1, v2);
    if (!(extent > 0.0f)) {
        return make_float3(0.0f, 0.0f, 0.0f);
    }
    const float3 n = cross(e1 / extent, e2 / extent);
    // A sliver's cross product may be as small as 1e-14, whose square is still a normal float.
    const float n_length = length(n);
    return n_length > 0.0f ? n / n_length : make_float3(0.0f, 0.0f, 0.0f);
}

/// Returns the point (1 - u - v) v0 + u v1 + v v2.
///
/// With w0 = 1 - u - v, each coordinate's rounding error is at most gamma(7) (|w0 v0| + |u v1| + |v
/// v2|), where gamma(n) = n u / (1 - n u) and u = 2^-24 (PBRT, section 6.8.1). The error of the
/// next triangle test near this point is added. With the triangle's size E, it is 6 u E for the
/// shear (traversal_ray.h) and as much again for its distances, hence 16 u E with a margin.
///
/// `normal` and `extent` are those of triangle_normal and triangle_extent, which a scene stores.
DEVICE SurfacePoint surface_point_of(float3 v0, float3 v1, float3 v2, float3 normal, float extent,
                                     float u, float v) {
    const float w = 1.0f - u - v;
    SurfacePoint point;
    point.position = w * v0 + u * v1 + v * v2;
    point.normal = normal;
    const float test_error = 9.53674316e-7f * extent;                              // 16 u E
    point.error = 4.17232700e-7f * (fabs(w * v0) + fabs(u * v1) + fabs(v * v2)) +  // gamma(7)
                  make_float3(test_error, test_error, test_error);
    return point;
}

/// surface_point_of, for a triangle without stored normal and extent.
DEVICE SurfacePoint surface_point(float3 v0, float3 v1, float3 v2, float u, float v) {
    return surface_point_of(v0, v1, v2, triangle_normal(v0, v1, v2), triangle_extent(v0, v1, v2), u,
                            v);
}

/// Returns the float next to x in the direction of `towards`'s sign, or x itself if that is 0.
DEVICE float next_float(float x, float towards) {
    if (towards == 0.0f) {
        return x;
    }
    if (x == 0.0f) {
        return towards > 0.0f ? as_float(1u) : as_float(0x80000001u);
    }
    const uint bits = as_uint(x);
    return as_float((x > 0.0f) == (towards > 0.0f) ? bits + 1u : bits - 1u);
}

/// Returns the origin of a ray that leaves `point` along `direction` (of any length). It is on the
/// side of the surface to which the direction points, far enough that the surface itself is not hit
/// again. For a shadow ray, move both ends, each towards the other, and use their difference as
/// direction with t_max = 1.
DEVICE float3 offset_ray_origin(SurfacePoint point, float3 direction) {
    const float distance = dot(fabs(point.normal), point.error);
    const float signed_distance = dot(point.normal, direction) < 0.0f ? -distance : distance;
    const float3 offset = point.normal * signed_distance;
    const float3 moved = point.position + offset;
    // Rounding the sum must not bring the origin back.
    return make_float3(next_float(moved.x, offset.x), next_float(moved.y, offset.y),
                       next_float(moved.z, offset.z));
}
