// SPDX-License-Identifier: MIT
// The object space of a shape, and rays in it.
//
// Let u = 2^-24 and gamma(n) = n u / (1 - n u) (Higham 2002, lemma 3.1). M is the linear part of a
// shape's world_from_object, A = object_from_world its inverse, rounded from double.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

#define HALF_ULP 5.9604645e-8f  ///< u

/// A ray in object space: the point at s is origin + s * direction, at t = t_origin + s * t_scale
/// of the world ray.
typedef struct ShapeRay {
    float3 origin;
    float3 direction;  ///< unit
    float t_origin;
    float t_scale;  ///< positive
} ShapeRay;

DEVICE float3 shape_centre(GLOBAL const ShapeRecord *shape) {
    return make_float3(shape->world_from_object[0][3], shape->world_from_object[1][3],
                       shape->world_from_object[2][3]);
}

/// A v. Each component is within gamma(4) of (|A| |v|), the rounding of A included.
DEVICE float3 vector_to_object(GLOBAL const ShapeRecord *shape, float3 v) {
    return make_float3(shape->object_from_world[0][0] * v.x + shape->object_from_world[0][1] * v.y +
                           shape->object_from_world[0][2] * v.z,
                       shape->object_from_world[1][0] * v.x + shape->object_from_world[1][1] * v.y +
                           shape->object_from_world[1][2] * v.z,
                       shape->object_from_world[2][0] * v.x + shape->object_from_world[2][1] * v.y +
                           shape->object_from_world[2][2] * v.z);
}

/// M v, of differences of points. Each component is within gamma(3) of (|M| |v|).
DEVICE float3 vector_to_world(GLOBAL const ShapeRecord *shape, float3 v) {
    return make_float3(shape->world_from_object[0][0] * v.x + shape->world_from_object[0][1] * v.y +
                           shape->world_from_object[0][2] * v.z,
                       shape->world_from_object[1][0] * v.x + shape->world_from_object[1][1] * v.y +
                           shape->world_from_object[1][2] * v.z,
                       shape->world_from_object[2][0] * v.x + shape->world_from_object[2][1] * v.y +
                           shape->world_from_object[2][2] * v.z);
}

/// |M| m of magnitudes m.
DEVICE float3 magnitude_to_world(GLOBAL const ShapeRecord *shape, float3 m) {
    return make_float3(
        fabs(shape->world_from_object[0][0]) * m.x + fabs(shape->world_from_object[0][1]) * m.y +
            fabs(shape->world_from_object[0][2]) * m.z,
        fabs(shape->world_from_object[1][0]) * m.x + fabs(shape->world_from_object[1][1]) * m.y +
            fabs(shape->world_from_object[1][2]) * m.z,
        fabs(shape->world_from_object[2][0]) * m.x + fabs(shape->world_from_object[2][1]) * m.y +
            fabs(shape->world_from_object[2][2]) * m.z);
}

/// |A| m of magnitudes m.
DEVICE float3 magnitude_to_object(GLOBAL const ShapeRecord *shape, float3 m) {
    return make_float3(
        fabs(shape->object_from_world[0][0]) * m.x + fabs(shape->object_from_world[0][1]) * m.y +
            fabs(shape->object_from_world[0][2]) * m.z,
        fabs(shape->object_from_world[1][0]) * m.x + fabs(shape->object_from_world[1][1]) * m.y +
            fabs(shape->object_from_world[1][2]) * m.z,
        fabs(shape->object_from_world[2][0]) * m.x + fabs(shape->object_from_world[2][1]) * m.y +
            fabs(shape->object_from_world[2][2]) * m.z);
}

/// A^T g: gradients transform by the inverse transpose, so a mirrored shape keeps its front.
DEVICE float3 gradient_to_world(GLOBAL const ShapeRecord *shape, float3 g) {
    return make_float3(shape->object_from_world[0][0] * g.x + shape->object_from_world[1][0] * g.y +
                           shape->object_from_world[2][0] * g.z,
                       shape->object_from_world[0][1] * g.x + shape->object_from_world[1][1] * g.y +
                           shape->object_from_world[2][1] * g.z,
                       shape->object_from_world[0][2] * g.x + shape->object_from_world[1][2] * g.y +
                           shape->object_from_world[2][2] * g.z);
}

/// Whether a line of object space certainly misses the sphere around the shape, far from which `p`
/// is; `d` has a length in [0.5, 1]. Its distance to the centre is |p x d| / |d|. With k as of
/// ShapeRecord, p and d, which were transformed, are within 5 u k of themselves (|A| |v| <= k |A
/// v|), and the products within 4 u of |p| |d|: the cross product is within e = 16 u k |p| |d|, as
/// k >= 3. (r |d| + e)^2 is at most 1.05 r^2 |d|^2 + 21 e^2. NaN is no miss.
DEVICE bool misses_bound(GLOBAL const ShapeRecord *shape, float3 p, float3 d) {
    const float3 moment = cross(p, d);
    return dot(moment, moment) >
           (1.05f * shape->bound2 + 21.0f * shape->error2 * dot(p, p)) * dot(d, d);
}

/// x - y - (x - y rounded): exact (Knuth's two-sum).
DEVICE float difference_error(float x, float y, float difference) {
    const float minus_y = difference - x;
    return (x - (difference - minus_y)) - (y + minus_y);
}

/// Moves a world ray into object space. False when it cannot hit the shape: it misses the sphere
/// around it, leads away from it, or is not finite. Scales of the shape and lengths of the
/// direction should lie in [1e-12, 1e12].
///
/// A ray from within twice that sphere keeps its origin, so that s = 0 is the origin exactly and
/// the sign of s that of t. From farther away everything would be lost in the size of the origin
/// (at 1e5 radii its ulp is 0.006 radii); there the ray is moved in world space to where it passes
/// the object. Only t0 is rounded: origin - centre is kept in two floats and t0 * direction is
/// added by fma, so the moved origin is a point of the ray to within u of itself, whatever the
/// distance. The second step makes good for the rounding of the first t0 beyond 1e6 radii.
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
    const bool is_far =
        dot(p, p) > 4.0f * shape->bound2;  // never for a plane; infinite squares count as far
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
