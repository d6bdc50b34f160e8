// SPDX-License-Identifier: MIT
// Intersection of rays with the shapes of a scene. All shapes whose balls a ray meets are tested
// one after the other, as scenes have few shapes.
#pragma once

#include "renderer/kernels/geometry/julia.h"
#include "renderer/kernels/geometry/quadric.h"
#include "renderer/kernels/geometry/shape_bounds.h"
#include "renderer/kernels/geometry/shape_point.h"
#include "renderer/kernels/geometry/shape_space.h"
#include "renderer/kernels/traversal/opacity.h"
#include "renderer/shared/hit_primitive.h"

/// The nearest hit of a ray with a shape.
typedef struct ShapeHit {
    float t;     ///< distance in lengths of the direction
    uint shape;  ///< index of the shape, or NO_HIT
    /// In the shape's object space, within a few ulps of its size of its surface.
    float3 object_point;
} ShapeHit;

/// Returns whether a shape stops the ray at its hit number `hit`. Julia sets are opaque.
DEVICE bool shape_stops(PRIVATE const OpacityTest *test, GLOBAL const ShapeRecord *shape,
                        uint index, uint hit, float3 object_point) {
    if (test->opacities == 0 || shape->opacity == OPAQUE) {
        return true;
    }
    const float opacity = opacity_at(test, shape->opacity, shape_uv(shape, object_point));
    return is_stopped(test->ray, ~index, hit, opacity);
}

/// Finds the nearest hit at 0 < t < t_max with the shape of this index that stops the ray.
DEVICE bool intersect_shape(GLOBAL const ShapeRecord *shapes, uint index, float3 origin,
                            float3 direction, float t_max, PRIVATE const OpacityTest *opacity,
                            PRIVATE float *t, PRIVATE float3 *object_point) {
    GLOBAL const ShapeRecord *shape = shapes + index;
    ShapeRay ray;
    if (!make_shape_ray(shape, origin, direction, &ray)) {
        return false;
    }
    if (is_julia(shape)) {
        return intersect_julia(shape, ray, t_max, t, object_point);
    }
    float t_min = 0.0f;
    for (uint hit = 0; intersect_quadric(shape, ray, t_min, t_max, t, object_point); ++hit) {
        if (shape_stops(opacity, shape, index, hit, *object_point)) {
            return true;
        }
        t_min = *t;
    }
    return false;
}

/// Returns the nearest hit at 0 < t < t_max that stops the ray; t_max may be INFINITY. Directions
/// may have any length. Rays that are not finite hit nothing.
DEVICE ShapeHit nearest_shape(GLOBAL const ShapeRecord *shapes,
                              GLOBAL const ShapeBounds *shape_bounds, uint shape_count,
                              float3 origin, float3 direction, float t_max, OpacityTest opacity) {
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
            if (intersect_shape(shapes, i, origin, direction, hit.t, &opacity, &t, &p)) {
                hit.t = t;
                hit.shape = i;
                hit.object_point = p;
            }
        }
    }
    return hit;
}

/// Returns whether a shape stops the ray at 0 < t < t_max. It is true exactly if `nearest_shape`
/// finds a hit: both test the same shapes in the same order, with the same bound until the first
/// hit.
DEVICE bool any_shape(GLOBAL const ShapeRecord *shapes, GLOBAL const ShapeBounds *shape_bounds,
                      uint shape_count, float3 origin, float3 direction, float t_max,
                      OpacityTest opacity) {
    for (uint first = 0; first < shape_count; first += SHAPE_LANES) {
        uint near = shapes_in_reach(shape_bounds + first / SHAPE_LANES, shape_count - first, origin,
                                    direction, t_max);
        for (; near != 0u; near &= near - 1u) {
            float t;
            float3 p;
            if (intersect_shape(shapes, first + lowest_bit(near), origin, direction, t_max,
                                &opacity, &t, &p)) {
                return true;
            }
        }
    }
    return false;
}
