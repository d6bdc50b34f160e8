// SPDX-License-Identifier: MIT
// Intersection of rays with the shapes of a scene. All shapes whose balls a ray meets are tested
// one after the other, as scenes have few shapes.
#pragma once

#include "renderer/kernels/geometry/julia.h"
#include "renderer/kernels/geometry/quadric.h"
#include "renderer/kernels/geometry/shape_bounds.h"
#include "renderer/kernels/geometry/shape_space.h"
#include "renderer/shared/hit_primitive.h"

/// The nearest hit of a ray with a shape.
typedef struct ShapeHit {
    float t;     ///< distance in lengths of the direction
    uint shape;  ///< index of the shape, or NO_HIT
    /// In the shape's object space, within a few ulps of its size of its surface.
    float3 object_point;
} ShapeHit;

/// Finds the nearest hit with one shape at 0 < t < t_max.
DEVICE bool intersect_shape(GLOBAL const ShapeRecord *shape, float3 origin, float3 direction,
                            float t_max, PRIVATE float *t, PRIVATE float3 *object_point) {
    ShapeRay ray;
    if (!make_shape_ray(shape, origin, direction, &ray)) {
        return false;
    }
    return is_julia(shape) ? intersect_julia(shape, ray, t_max, t, object_point)
                           : intersect_quadric(shape, ray, t_max, t, object_point);
}

/// Returns the nearest hit at 0 < t < t_max, where t_max may be INFINITY. Directions may have any
/// length. Rays that are not finite hit nothing.
DEVICE ShapeHit nearest_shape(GLOBAL const ShapeRecord *shapes,
                              GLOBAL const ShapeBounds *shape_bounds, uint shape_count,
                              float3 origin, float3 direction, float t_max) {
    ShapeHit hit;
    hit.t = t_max;
    hit.shape = NO_HIT;
    hit.object_point = make_float3(0.0f, 0.0f, 0.0f);
    for (uint first = 0; first < shape_count; first += SHAPE_LANES) {
        uint near = shapes_in_reach(shape_bounds + first / SHAPE_LANES, shape_count - first, origin,
                                    direction, hit.t);
        for (; near != 0u; near &= near - 1u) {
            const uint i = first + lowest_bit(near);
            float t;
            float3 p;
            if (intersect_shape(shapes + i, origin, direction, hit.t, &t, &p)) {
                hit.t = t;
                hit.shape = i;
                hit.object_point = p;
            }
        }
    }
    return hit;
}

/// Returns whether a shape is hit at 0 < t < t_max. It is true exactly if `nearest_shape` finds a
/// hit: both test the same shapes in the same order, with the same bound until the first hit.
DEVICE bool any_shape(GLOBAL const ShapeRecord *shapes, GLOBAL const ShapeBounds *shape_bounds,
                      uint shape_count, float3 origin, float3 direction, float t_max) {
    for (uint first = 0; first < shape_count; first += SHAPE_LANES) {
        uint near = shapes_in_reach(shape_bounds + first / SHAPE_LANES, shape_count - first, origin,
                                    direction, t_max);
        for (; near != 0u; near &= near - 1u) {
            float t;
            float3 p;
            if (intersect_shape(shapes + first + lowest_bit(near), origin, direction, t_max, &t,
                                &p)) {
                return true;
            }
        }
    }
    return false;
}
