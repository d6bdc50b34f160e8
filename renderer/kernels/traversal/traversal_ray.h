// SPDX-License-Identifier: MIT
// A ray prepared for traversal: values for the box test and the triangle test, computed once.
//
// Source: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013; T.
// Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013. Departure: the margin of the box test, derived
// below.
//
// The triangle test moves a vertex to the ray's frame as x' = (x - ox) - sx (z - oz), where z is
// the axis of the largest direction component and |sx| <= 1. With u = 2^-24, its rounding error is
// at most u (2 |x - ox| + 4 |z - oz|) to first order. That is below 6 u E, where E bounds the
// distance along any axis from the origin to a point of the scene. The tested triangle thus differs
// slightly from the one that the boxes enclose. Boxes widened by 8 u E on every side enclose it
// again. Widening the box is equivalent to shifting the origin: outwards for the planes of entry,
// inwards for those of exit. It costs nothing per box. The rounding of the shifted origin itself
// adds 2 u |o|. Ize's factor on the distance of exit covers the three roundings of a slab distance.
#pragma once

#include "renderer/shared/compat.h"

/// A ray prepared for traversal.
typedef struct TraversalRay {
    float entry_origin[3];  ///< origin shifted so that boxes are entered early
    float exit_origin[3];   ///< origin shifted so that boxes are left late
    float inverse[3];       ///< 1 / direction; infinite where the direction is 0
    uint entry_side[3];     ///< 0 if a slab is entered at its lower plane, 1 at its upper plane
    uint kx, ky, kz;        ///< axes; kz is that of the largest direction component
    float ox, oy, oz;       ///< origin along kx, ky, kz
    float sx, sy, sz;       ///< shear and scale that map the direction to +z with length 1
} TraversalRay;

/// Prepares a ray. Returns false for rays that cannot hit anything: those with a NaN or infinite
/// component or a zero direction. `scene_lower` and `scene_upper` bound all geometry. Directions
/// need not be unit vectors. Distances are multiples of their length, which should be in [1e-12,
/// 1e12].
DEVICE bool make_traversal_ray(float3 origin, float3 direction, float3 scene_lower,
                               float3 scene_upper, PRIVATE TraversalRay *ray) {
    const float o[3] = {origin.x, origin.y, origin.z};
    const float d[3] = {direction.x, direction.y, direction.z};
    const float lower[3] = {scene_lower.x, scene_lower.y, scene_lower.z};
    const float upper[3] = {scene_upper.x, scene_upper.y, scene_upper.z};
    float extent = 0.0f;
    bool finite = true;
    for (uint axis = 0; axis < 3; ++axis) {
        finite = finite && isfinite(o[axis]) && isfinite(d[axis]) && lower[axis] <= upper[axis];
        extent = max(extent, max(fabs(lower[axis] - o[axis]), fabs(upper[axis] - o[axis])));
    }
    const float ax = fabs(d[0]);
    const float ay = fabs(d[1]);
    const float az = fabs(d[2]);
    ray->kz = ax > ay ? (ax > az ? 0u : 2u) : (ay > az ? 1u : 2u);
    if (!finite || d[ray->kz] == 0.0f) {
        return false;
    }
    ray->kx = ray->kz == 2u ? 0u : ray->kz + 1u;
    ray->ky = ray->kx == 2u ? 0u : ray->kx + 1u;
    ray->ox = o[ray->kx];
    ray->oy = o[ray->ky];
    ray->oz = o[ray->kz];
    ray->sx = d[ray->kx] / d[ray->kz];
    ray->sy = d[ray->ky] / d[ray->kz];
    ray->sz = 1.0f / d[ray->kz];
    for (uint axis = 0; axis < 3; ++axis) {
        // 8 u E + 2 u |o|.
        const float margin = 4.76837158e-7f * extent + 1.1920929e-7f * fabs(o[axis]);
        const float outwards = d[axis] < 0.0f ? -margin : margin;
        ray->entry_origin[axis] = o[axis] + outwards;
        ray->exit_origin[axis] = o[axis] - outwards;
        ray->inverse[axis] = 1.0f / (d[axis] == 0.0f ? 0.0f : d[axis]);  // -0 counts as +0
        ray->entry_side[axis] = d[axis] < 0.0f ? 1u : 0u;
    }
    return true;
}
