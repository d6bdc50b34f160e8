// SPDX-License-Identifier: MIT
// The intersection test of a ray with one box.
#pragma once

#include "renderer/kernels/traversal/traversal_ray.h"

/// Returns the distance at which the ray enters the box [lower, upper][x, y, z], or INFINITY if it
/// misses the box within [0, t_max]. The test is conservative (traversal_ray.h). If 0 x infinity
/// makes a slab distance NaN, the origin is on a plane along which the ray runs. The comparison is
/// then false and keeps the other operand, so the box counts as hit.
DEVICE float intersect_box(GLOBAL const float (*bounds)[3], PRIVATE const TraversalRay *ray,
                           float t_max) {
    float entry = 0.0f;
    float exit = t_max;
    for (uint axis = 0; axis < 3; ++axis) {
        const uint side = ray->entry_side[axis];
        const float in = (bounds[side][axis] - ray->entry_origin[axis]) * ray->inverse[axis];
        const float out = (bounds[1u - side][axis] - ray->exit_origin[axis]) * ray->inverse[axis];
        entry = in > entry ? in : entry;
        exit = out < exit ? out : exit;
    }
    return entry <= exit * 1.00000048f ? entry : INFINITY;  // 1 + 2 gamma(3), Ize 2013
}
