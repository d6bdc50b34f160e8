// SPDX-License-Identifier: MIT
// The object space of a shape, and rays in it.
//
// Let u = 2^-24 and gamma(n) = n u / (1 - n u) (Higham 2002, lemma 3.1). M is the linear part of a
// shape's world_from_object. A = object_from_world is its inverse, rounded from double.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

#define HALF_ULP 5.9604645e-8f  ///< u

/// A ray in object space. The point at s is origin + s * direction, at t = t_origin + s * t_scale
/// on the world ray.
typedef struct ShapeRay {
    float3 origin;
    float3 direction;  ///< unit
    float t_origin;
    float t_scale;  ///< positive
} ShapeRay;

/// Returns whether a shape is a Julia set; all other shapes are quadrics.
DEVICE bool is_julia(GLOBAL const ShapeRecord *shape) {
    return FEATURE_julia && (!FEATURE_quadrics || shape->kind == SHAPE_JULIA);
}

DEVICE float3 shape_centre(GLOBAL const ShapeRecord *shape) {
    return make_float3(shape->world_from_object[0][3], shape->world_from_object[1][3],
                       shape->world_from_object[2][3]);
}

/// Returns A v. Each component is within gamma(4) (|A| |v|) of the exact one, including the
/// rounding of A.
DEVICE float3 vector_to_object(GLOBAL const ShapeRecord *shape, float3 v) {
    return make_float3(shape->object_from_world[0][0] * v.x + shape->object_from_world[0][1] * v.y +
                           shape->object_from_world[0][2] * v.z,
                       shape->object_from_world[1][0] * v.x + shape->object_from_world[1][1] * v.y +
                           shape->object_from_world[1][2] * v.z,
                       shape->object_from_world[2][0] * v.x + shape->object_from_world[2][1] * v.y +
                           shape->object_from_world[2][2] * v.z);
}

/// Returns M v, for v a difference of points. Each component is within gamma(3) (|M| |v|) of the
/// exact one.
DEVICE float3 vector_to_world(GLOBAL const ShapeRecord *shape, float3 v) {
    return make_float3(shape->world_from_object[0][0] * v.x + shape->world_from_object[0][1] * v.y +
                           shape->world_from_object[0][2] * v.z,
                       shape->world_from_object[1][0] * v.x + shape->world_from_object[1][1] * v.y +
                           shape->world_from_object[1][2] * v.z,
                       shape->world_from_object[2][0] * v.x + shape->world_from_object[2][1] * v.y +
                           shape->world_from_object[2][2] * v.z);
}

/// Returns |M| m, for a vector m of magnitudes.
DEVICE float3 magnitude_to_world(GLOBAL const ShapeRecord *shape, float3 m) {
    return make_float3(
        fabs(shape->world_from_object[0][0]) * m.x + fabs(shape->world_from_object[0][1]) * m.y +
            fabs(shape->world_from_object[0][2]) * m.z,
        fabs(shape->world_from_object[1][0]) * m.x + fabs(shape->world_from_object[1][1]) * m.y +
            fabs(shape->world_from_object[1][2]) * m.z,
        fabs(shape->world_from_object[2][0]) * m.x + fabs(shape->world_from_object[2][1]) * m.y +
            fabs(shape->world_from_object[2][2]) * m.z);
}

/// Returns |A| m, for a vector m of magnitudes.
DEVICE float3 magnitude_to_object(GLOBAL const ShapeRecord *shape, float3 m) {
    return make_float3(
        fabs(shape->object_from_world[0][0]) * m.x + fabs(shape->object_from_world[0][1]) * m.y +
            fabs(shape->object_from_world[0][2]) * m.z,
        fabs(shape->object_from_world[1][0]) * m.x + fabs(shape->object_from_world[1][1]) * m.y +
            fabs(shape->object_from_world[1][2]) * m.z,
        fabs(shape->object_from_world[2][0]) * m.x + fabs(shape->object_from_world[2][1]) * m.y +
            fabs(shape->object_from_world[2][2]) * m.z);
}

/// Returns A^T g. Gradients transform by the inverse transpose, so a mirrored shape keeps its
/// front.
DEVICE float3 gradient_to_world(GLOBAL const ShapeRecord *shape, float3 g) {
    return make_float3(shape->object_from_world[0][0] * g.x + shape->object_from_world[1][0] * g.y +
                           shape->object_from_world[2][0] * g.z,
                       shape->object_from_world[0][1] * g.x + shape->object_from_world[1][1] * g.y +
                           shape->object_from_world[2][1] * g.z,
                       shape->object_from_world[0][2] * g.x + shape->object_from_world[1][2] * g.y +
                           shape->object_from_world[2][2] * g.z);
}

/// Returns whether a line in object space certainly misses the sphere around the shape. `p` is far
/// from the sphere, and the length of `d` is in [0.5, 1].
///
/// The distance of the line to the centre is |p x d| / |d|. With k of ShapeRecord, the transformed
/// p and d are within 5 u k of their magnitudes (|A| |v| <= k |A v|), and the products within 4 u
/// of |p| |d|. The cross product is therefore within e = 16 u k |p| |d|, as k >= 3. (r |d| + e)^2
/// is at most 1.05 r^2 |d|^2 + 21 e^2. NaN is no miss.
DEVICE bool misses_bound(GLOBAL const ShapeRecord *shape, float3 p, float3 d) {
    const float3 moment = cross(p, d);
    return dot(moment, moment) >
           (1.05f * shape->bound2 + 21.0f * shape->error2 * dot(p, p)) * dot(d, d);
}

/// Returns x - y minus the rounded x - y, exactly (Knuth's two-sum).
DEVICE float difference_error(float x, float y, float difference) {
    const float minus_y = difference - x;
    return (x - (difference - minus_y)) - (y + minus_y);
}

/// Transforms a world ray into object space. Returns false if it cannot hit the shape: it misses
/// the sphere around it, points away from it, or is not finite. The scale of the shape and the
/// length of the direction should be in [1e-12, 1e12].
///
/// A ray that starts within twice the radius of that sphere keeps its origin. Then s = 0 is the
/// origin exactly, and s has the sign of t. From farther away the size of the origin would hide all
/// detail: at 1e5 radii its ulp is 0.006 radii. Such a ray is moved in world space, by a distance
/// t0, to where it passes the object. Only t0 is rounded: origin - centre is stored in two floats,
/// and t0 * direction is added by fma. The moved origin is thus a point of the ray to within u of
/// itself, whatever the distance. The second step corrects the rounding of the first t0 beyond 1e6
/// radii.
DEVICE bool make_shape_ray(GLOBAL const ShapeRecord *shape, float3 origin, float3 direction,
                           PRIVATE ShapeRay *ray) {
    const float3 d = vector_to_object(shape, direction);
    const float size = fabs(d.x) + fabs(d.y) + fabs(d.z);
    const float3 centre = shape_centre(shape);
    float3 from_centre = origin - centre;
    float3 p = vector_to_object(shape, from_centre);
    if (!(size > 1e-30f && size < 1e30f && fabs(p.x) + fabs(p.y) + fabs(p.z) < 1e30f)) {
        return false;
    }
    const float3 scaled = d / size;  // its length is in [0.57, 1]
    // Never true for a plane. Infinite squares count as far.
    const bool is_far = dot(p, p) > 4.0f * shape->bound2;
    if (is_far && (!(dot(p, scaled) < 0.0f) || misses_bound(shape, p, scaled))) {
        return false;
    }
    const float scaled_length = length(scaled);
    ray->direction = scaled / scaled_length;
    ray->t_scale = 1.0f / (size * scaled_length);
    ray->t_origin = 0.0f;
    ray->origin = p;
    if (!is_far) {
        return true;
    }
    const float3 residual = make_float3(difference_error(origin.x, centre.x, from_centre.x),
                                        difference_error(origin.y, centre.y, from_centre.y),
                                        difference_error(origin.z, centre.z, from_centre.z));
    for (uint i = 0; i < 2u; ++i) {
        const float t = -dot(p, ray->direction) * ray->t_scale;
        from_centre =
            make_float3(fma(t, direction.x, from_centre.x), fma(t, direction.y, from_centre.y),
                        fma(t, direction.z, from_centre.z));
        if (i == 0u) {
            from_centre = from_centre + residual;
        }
        p = vector_to_object(shape, from_centre);
        ray->t_origin += t;
        if (dot(p, p) < shape->bound2) {
            break;
        }
    }
    ray->origin = p;
    return dot(p, p) <= 1.01f * shape->bound2;
}
