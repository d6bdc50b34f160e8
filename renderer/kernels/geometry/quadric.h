// SPDX-License-Identifier: MIT
// Intersection with quadrics of revolution, q(x, y, z) = a (x^2 + y^2) + b z^2 + c z + d = 0,
// clipped in z.
//
// They comprise sphere, cylinder, cone, paraboloid and hyperboloid; disc and plane have a = b = 0.
// All computations are in object space. Stable roots follow W. H. Press et al., "Numerical
// Recipes", 3rd ed., section 5.6. shape_space.h handles tiny and distant objects.
#pragma once

#include "renderer/kernels/geometry/shape_space.h"

/// Returns q(p).
DEVICE float quadric_value(GLOBAL const ShapeRecord *q, float3 p) {
    return q->a * (p.x * p.x + p.y * p.y) + q->b * (p.z * p.z) + q->c * p.z + q->d;
}

/// Returns the sum of the magnitudes of the terms of q(p). The rounding error of quadric_value is
/// at most gamma(5) times this sum.
DEVICE float quadric_magnitude(GLOBAL const ShapeRecord *q, float3 p) {
    return fabs(q->a) * (p.x * p.x + p.y * p.y) + fabs(q->b) * (p.z * p.z) + fabs(q->c * p.z) +
           fabs(q->d);
}

/// Returns half the gradient. It points to the side where q grows, which is the front of every
/// kind.
DEVICE float3 quadric_half_gradient(GLOBAL const ShapeRecord *q, float3 p) {
    return make_float3(q->a * p.x, q->a * p.y, q->b * p.z + 0.5f * q->c);
}

/// Returns half the derivative of the quadric along d.
DEVICE float quadric_half_slope(GLOBAL const ShapeRecord *q, float3 p, float3 d) {
    return q->a * (p.x * d.x + p.y * d.y) + q->b * (p.z * d.z) + 0.5f * q->c * d.z;
}

/// Returns whether the ray hits the surface at shift + s with t_min < t < t_max; the ray's origin
/// is the point at `shift`. A Newton step moves the point onto the surface and squares its error
/// across it; then the point is clipped. Comparisons are such that NaN is a miss.
DEVICE bool quadric_hit(GLOBAL const ShapeRecord *q, ShapeRay ray, float shift, float s,
                        float t_min, float t_max, PRIVATE float *t, PRIVATE float3 *p) {
    *t = ray.t_origin + (shift + s) * ray.t_scale;
    if (!(*t > t_min && *t < t_max)) {
        return false;
    }
    float3 point = ray.origin + ray.direction * s;
    const float3 g = quadric_half_gradient(q, point);
    const float g2 = dot(g, g);
    // The condition excludes the apex of a cone. Near it |q| <= g2, so the step is at most half the
    // distance to the apex.
    if (g2 > 0.0f) {
        point = point - g * (0.5f * quadric_value(q, point) / g2);
    }
    *p = point;
    return point.z >= q->z_lower && point.z <= q->z_upper && dot(point, point) <= q->bound2;
}

/// Finds the first hit at t_min < t < t_max, where t_min is at least 0. Let A s^2 + 2 B s + C be
/// the quadric along the ray.
/// - The signs of A, B and C at the ray's origin tell on which side of it the roots are. The root
///   of smaller modulus is C / w and the other w / A, with w = -(B + sign(B) sqrt(B^2 - A C))
///   (Press et al.). If C > 0, B >= 0 and A >= 0, as for a ray that leaves a convex surface from
///   outside, there is no hit. If C < 0 < A, as for a ray that starts inside, there is exactly one.
///   A ray that was moved (t_origin > 0) has both roots ahead.
/// - The roots themselves are computed about the ray's point nearest to the object's origin, which
///   fma places on the ray. Their error is that of a shift of the ray by a few u of its distance
///   there, or of the surface's size. About any other point the terms of the discriminant would
///   cancel, worst near the apex of a cone, where both roots coincide. A plane has no size, and its
///   discriminant has no second term; its roots are computed about the ray's own origin.
/// - A = 0 leaves one root: for a plane, or for an axis-parallel ray and a paraboloid.
DEVICE bool intersect_quadric(GLOBAL const ShapeRecord *q, ShapeRay ray, float t_min, float t_max,
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
    // w = 0 is a tangent at its point. If c = 0 as well, s0 is NaN, which is a miss.
    const float s0 = c / w;
    const float s1 = a == 0.0f ? s0 : w / a;
    ray.origin = near;
    return (both && quadric_hit(q, ray, shift, s0 < s1 ? s0 : s1, t_min, t_max, t, p)) ||
           quadric_hit(q, ray, shift, s0 < s1 ? s1 : s0, t_min, t_max, t, p);
}
