// SPDX-License-Identifier: MIT
// Quadrics of revolution q(x, y, z) = a (x^2 + y^2) + b z^2 + c z + d = 0, clipped in z: sphere,
// cylinder, cone, paraboloid, hyperboloid; disc and plane are those with a = b = 0. Object space
// throughout.
//
// Stable roots: W. H. Press et al., "Numerical Recipes", 3rd ed., 5.6. What tiny and far objects
// need besides is in shape_space.h.
#pragma once

#include "renderer/kernels/geometry/shape_space.h"

#if FEATURE_quadrics

DEVICE float quadric_value(GLOBAL const ShapeRecord *q, float3 p) {
    return q->a * (p.x * p.x + p.y * p.y) + q->b * (p.z * p.z) + q->c * p.z + q->d;
}

/// Sum of the magnitudes of the terms: quadric_value is within gamma(5) of it.
DEVICE float quadric_magnitude(GLOBAL const ShapeRecord *q, float3 p) {
    return fabs(q->a) * (p.x * p.x + p.y * p.y) + fabs(q->b) * (p.z * p.z) + fabs(q->c * p.z) +
           fabs(q->d);
}

/// Half the gradient: on the side where q grows, which is the front of every kind.
DEVICE float3 quadric_half_gradient(GLOBAL const ShapeRecord *q, float3 p) {
    return make_float3(q->a * p.x, q->a * p.y, q->b * p.z + 0.5f * q->c);
}

/// Half the derivative of the quadric along d.
DEVICE float quadric_half_slope(GLOBAL const ShapeRecord *q, float3 p, float3 d) {
    return q->a * (p.x * d.x + p.y * d.y) + q->b * (p.z * d.z) + 0.5f * q->c * d.z;
}

/// Whether the ray hits the surface at shift + s, 0 < t < t_max; its origin is that at `shift`. The
/// point is moved onto the surface by a Newton step (its error across the surface is squared by
/// it), then clipped. Conditions are written so that NaN is a miss.
DEVICE bool quadric_hit(GLOBAL const ShapeRecord *q, ShapeRay ray, float shift, float s,
                        float t_max, PRIVATE float *t, PRIVATE float3 *p) {
    *t = ray.t_origin + (shift + s) * ray.t_scale;
    if (!(*t > 0.0f && *t < t_max)) {
        return false;
    }
    float3 point = ray.origin + ray.direction * s;
    const float3 g = quadric_half_gradient(q, point);
    const float g2 = dot(g, g);
    if (g2 > 0.0f) {  // not the apex of a cone; near it |q| <= g2, so the step is at most half the
                      // way to the apex
        point = point - g * (0.5f * quadric_value(q, point) / g2);
    }
    *p = point;
    return point.z >= q->z_lower && point.z <= q->z_upper && dot(point, point) <= q->bound2;
}

/// The first hit at 0 < t < t_max. Let A s^2 + 2 B s + C be the quadric along the ray.
/// - On which side of the ray's origin the roots lie is read from the signs of A, B and C there:
/// the root of
///   smaller modulus is C / w, the other w / A, with w = -(B + sign(B) sqrt(B^2 - A C)) (Press et
///   al.). So where C > 0, B >= 0 and A >= 0, as for a ray that leaves a convex surface from
///   outside, there is no hit; where C < 0 < A, as for a ray that starts inside, there is exactly
///   one. A ray that was moved (t_origin > 0) has both roots ahead.
/// - The roots themselves are taken about the point of the ray nearest to the object's origin,
/// where fma puts it
///   on the ray: their error is that of a shift of the ray by a few u of its distance there, or of
///   the surface's size. About any other point the terms of the discriminant would cancel, worst
///   near the apex of a cone, where both roots meet. A plane has no size, and its discriminant no
///   second term: there the ray's own origin serves.
/// - A = 0 leaves one root (a plane; an axis-parallel ray and a paraboloid).
DEVICE bool intersect_quadric(GLOBAL const ShapeRecord *q, ShapeRay ray, float t_max,
                              PRIVATE float *t, PRIVATE float3 *p) {
    const float3 d = ray.direction;
    const float3 o = ray.origin;
    const float a = q->a * (d.x * d.x + d.y * d.y) + q->b * (d.z * d.z);
    bool both = true;
    if (!(ray.t_origin > 0.0f)) {
        const float c = quadric_value(q, o);
        const bool falling = quadric_half_slope(q, o, d) < 0.0f;
        const bool small_ahead = falling ? c > 0.0f : c < 0.0f;
        const bool large_ahead = falling ? a > 0.0f : a < 0.0f;
        if (!small_ahead && !large_ahead) {
            return false;
        }
        both = small_ahead && large_ahead;
    }
    const float shift = q->bound2 < SHAPE_UNBOUNDED ? -dot(o, d) : 0.0f;
    const float3 near =
        make_float3(fma(shift, d.x, o.x), fma(shift, d.y, o.y), fma(shift, d.z, o.z));
    const float b = quadric_half_slope(q, near, d);
    const float c = quadric_value(q, near);
    const float discriminant = b * b - a * c;
    if (!(discriminant >= 0.0f)) {
        return false;
    }
    const float w = -(b + copysign(sqrt(discriminant), b));
    const float s0 =
        c / w;  // w = 0, a tangent at its point: NaN where c = 0 as well, which no range takes
    const float s1 = a == 0.0f ? s0 : w / a;
    ray.origin = near;
    return (both && quadric_hit(q, ray, shift, s0 < s1 ? s0 : s1, t_max, t, p)) ||
           quadric_hit(q, ray, shift, s0 < s1 ? s1 : s0, t_max, t, p);
}

#endif
