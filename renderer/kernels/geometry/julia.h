// SPDX-License-Identifier: MIT
// Intersection with quaternion Julia sets: the surface |z_n| = 4 of z <- z^2 + c, z_0 = (x, y, z,
// slice), in object space.
//
// J. C. Hart, D. J. Sandin, L. H. Kauffman, "Ray tracing deterministic 3-D fractals", SIGGRAPH
// 1989, march by an estimate of the distance, |z_n| log |z_n| / (2 |z_n'|). That is the distance to
// the limit set, not to this surface, and it is valid in the limit only. Departure: here a step is
// taken if a bound proves that it does not cross the surface. Along a step w the iterates are
// z_k(s) = z_k + s w_k + e_k(s), 0 <= s <= 1, with
//
//   w_k+1 = z_k w_k + w_k z_k
//   |e_k+1| <= |w_k|^2 + 2 (|z_k| + |w_k|) |e_k| + |e_k|^2,   e_0 = 0
//
// which follows by squaring, with |s| <= 1 and |pq| = |p| |q|. The segment [z_n, z_n + w_n],
// widened by the bound m_n of |e_n|, therefore contains all z_n(s). The step does not cross the
// surface if the widened segment is entirely outside or entirely inside 4. The model is of first
// order in the direction of the ray. Steps towards the surface thus converge like Newton's, and
// steps along it are of the order of the square root of the distance.
//
// Once |z_k| exceeds a modulus R >= 4 with R^2 - |c| >= R, it grows: the point is outside, and
// later iterates are not needed. A segment that is entirely beyond R at that k is outside as well.
//
// Rounding, with u = 2^-24: An iterate is computed from its predecessor to within 6 u (|z_k|^2 +
// |c|), with at most five roundings per component. w_k+1 is computed to within 6 u |z_k| |w_k|. The
// points of a ray are within 8 u r of it, where r is the radius of the sphere around the set. All
// three errors are added to m_k, so that a proven step does not cross the true surface.
//
// Error: below steps of 2^-16 r, rounding permits no proof. Such a step is taken unproven, and the
// sides of its ends are compared. A ray may thus miss the surface where it enters and leaves it
// again within 2^-16 r, or stays so close to it that rounding hides the crossing, and nowhere else.
// After 512 probes, steps are 1 / 500 of the ray's length in the sphere, so that the march ends.
// With n <= 12, rays take 50 probes on average and 350 at most. A crossing is bisected until the
// ends are neighbouring floats, so its distance is within 4 u r. The side of a point is in doubt
// where the surface is closer than the accumulated rounding of z_n divided by the gradient.
#pragma once

#include "renderer/kernels/geometry/shape_space.h"

#define JULIA_STEP 1.52587891e-5f  ///< 2^-16
#define JULIA_FINE_PROBES 512u
#define JULIA_COARSE_STEPS 500u

/// The quaternion real + (i, j, k).v.
typedef struct Quaternion {
    float real;
    float3 v;
} Quaternion;

DEVICE float quaternion_dot(Quaternion p, Quaternion q) {
    return p.real * q.real + dot(p.v, q.v);
}

/// Returns p q + q p, the derivative of q^2 along p.
DEVICE Quaternion quaternion_anticommutator(Quaternion p, Quaternion q) {
    Quaternion sum;
    sum.real = 2.0f * (p.real * q.real - dot(p.v, q.v));
    sum.v = (q.v * p.real + p.v * q.real) * 2.0f;
    return sum;
}

/// Returns z_0 of a point.
DEVICE Quaternion julia_start(GLOBAL const ShapeRecord *julia, float3 p) {
    Quaternion z;
    z.real = p.x;
    z.v = make_float3(p.y, p.z, julia->z_lower);
    return z;
}

/// Returns z^2 + c.
DEVICE Quaternion julia_next(GLOBAL const ShapeRecord *julia, Quaternion z) {
    Quaternion next;
    next.real = z.real * z.real - dot(z.v, z.v) + julia->a;
    next.v = z.v * (2.0f * z.real) + make_float3(julia->b, julia->c, julia->d);
    return next;
}

/// Returns |c|.
DEVICE float julia_modulus(GLOBAL const ShapeRecord *julia) {
    return sqrt(julia->a * julia->a + julia->b * julia->b + julia->c * julia->c +
                julia->d * julia->d);
}

/// Returns whether a point is outside the surface.
DEVICE bool julia_outside(GLOBAL const ShapeRecord *julia, float3 p) {
    const float escape = julia->z_upper;
    Quaternion z = julia_start(julia, p);
    for (uint i = 0; i < julia->iterations; ++i) {
        if (quaternion_dot(z, z) > escape * escape) {
            return true;
        }
        z = julia_next(julia, z);
    }
    return quaternion_dot(z, z) > 16.0f;
}

/// Result of probing a step from a point.
typedef struct JuliaProbe {
    bool outside;  ///< whether the point is outside
    bool clear;    ///< no point of the step is on the other side
    /// Multiple of the step that would be about clear next: from the step's end if it is clear,
    /// else from the point.
    float ratio;
} JuliaProbe;

/// Probes the step from p to p + step; r is the radius of the sphere around the set.
DEVICE JuliaProbe probe_julia(GLOBAL const ShapeRecord *julia, float3 p, float3 step, float r) {
    const float escape = julia->z_upper;
    const float modulus = julia_modulus(julia);
    Quaternion z = julia_start(julia, p);
    Quaternion w;
    w.real = step.x;
    w.v = make_float3(step.y, step.z, 0.0f);
    float m = 8.0f * HALF_ULP * r;
    float z2 = quaternion_dot(z, z);
    bool bounded = true;
    uint i = 0;
    // Twice the required modulus leaves room for a step.
    for (; i < julia->iterations && z2 <= 4.0f * escape * escape; ++i) {
        if (bounded) {
            const float z_length = sqrt(z2);
            const float w_length = sqrt(quaternion_dot(w, w));
            m = (w_length * w_length + 2.0f * (z_length + w_length) * m + m * m) * 1.00001f +
                6.0f * HALF_ULP * (z2 + modulus + z_length * w_length);
            w = quaternion_anticommutator(w, z);
            bounded = m < 1e4f && quaternion_dot(w, w) < 1e8f;  // squares stay far from overflow
        }
        z = julia_next(julia, z);
        z2 = quaternion_dot(z, z);
    }
    const float level = i < julia->iterations ? escape : 4.0f;
    const float z_length = sqrt(z2);
    JuliaProbe probe;
    probe.outside = z_length > level;
    probe.clear = false;
    probe.ratio = 0.1f;
    if (!bounded) {
        return probe;
    }
    const float zw = quaternion_dot(z, w);
    const float w2 = quaternion_dot(w, w);
    const float end_length = sqrt(max(z2 + 2.0f * zw + w2, 0.0f));
    float approach, curvature;
    // The smallest modulus along the segment decides outside the surface; the largest, which is at
    // an end, decides inside.
    if (probe.outside) {
        const float s = -zw >= w2 ? 1.0f : (zw < 0.0f ? -zw / w2 : 0.0f);
        probe.clear = sqrt(max(z2 + s * (2.0f * zw + s * w2), 0.0f)) * 0.99999f - m > level;
        approach = zw < 0.0f ? -zw / z_length : 0.0f;
        curvature = m;
    } else {
        probe.clear = max(z_length, end_length) * 1.00001f + m < level;
        approach = zw > 0.0f ? zw / z_length : 0.0f;
        curvature = m + 0.125f * w2;
    }
    // Solves gap = approach * ratio + curvature * ratio^2; m > 0 there.
    const float gap = fabs((probe.clear ? end_length : z_length) - level);
    probe.ratio =
        2.0f * gap / (approach + sqrt(approach * approach + 4.0f * curvature * gap) + 1e-30f);
    return probe;
}

/// Finds the first hit at 0 < t < t_max. The march does not depend on t_max.
DEVICE bool intersect_julia(GLOBAL const ShapeRecord *julia, ShapeRay ray, float t_max,
                            PRIVATE float *t, PRIVATE float3 *p) {
    const float3 o = ray.origin;
    const float3 d = ray.direction;
    // The chord of the ray in the sphere around the set, about the ray's point nearest to its
    // centre.
    const float middle = -dot(o, d);
    const float3 nearest =
        make_float3(fma(middle, d.x, o.x), fma(middle, d.y, o.y), fma(middle, d.z, o.z));
    const float half_chord2 = julia->bound2 - dot(nearest, nearest);
    if (!(half_chord2 > 0.0f)) {
        return false;
    }
    const float half_chord = sqrt(half_chord2);
    const float end = middle + half_chord;
    float s = middle - half_chord;
    const bool from_within = s < 0.0f && !(ray.t_origin > 0.0f);
    if (from_within) {
        s = 0.0f;
    }
    if (!(end > s)) {
        return false;
    }
    const float r = sqrt(julia->bound2);
    const float coarse = (end - s) / (float)JULIA_COARSE_STEPS;
    float step = 0.25f * (end - s);
    float before = s;  // the side of the start is proven from here to s
    bool start_outside = true;
    bool crossed = false;
    for (uint i = 0; i < JULIA_FINE_PROBES + JULIA_COARSE_STEPS + 2u; ++i) {
        const float shortest = i < JULIA_FINE_PROBES ? JULIA_STEP * r : coarse;
        step = i < JULIA_FINE_PROBES ? max(step, shortest) : coarse;
        const bool last = s + step >= end;
        if (last) {
            step = end - s;
        }
        const JuliaProbe probe = probe_julia(julia, o + d * s, d * step, r);
        if (i == 0u && from_within) {
            start_outside = probe.outside;
        }
        crossed = probe.outside != start_outside;
        if (crossed || s >= end || !(ray.t_origin + s * ray.t_scale < t_max)) {
            break;
        }
        if (probe.clear || step <= shortest) {
            before = s;
            s = last ? end : s + step;
            step *= min(max(0.9f * probe.ratio, 0.1f), 4.0f);
        } else {
            step *= min(max(0.9f * probe.ratio, 0.1f), 0.7f);
        }
    }
    if (!crossed) {
        return false;
    }
    float after = s;
    for (uint i = 0; i < 32u; ++i) {
        const float between = 0.5f * (before + after);
        if (!(between > before && between < after)) {
            break;
        }
        if (julia_outside(julia, o + d * between) == start_outside) {
            before = between;
        } else {
            after = between;
        }
    }
    *t = ray.t_origin + after * ray.t_scale;
    *p = o + d * after;
    return *t > 0.0f && *t < t_max;
}

/// Returns a positive multiple of the gradient of |z_n| at a point of the surface, which points
/// outwards. `residual` bounds, in the same units, the deviation of |z_n| from 4 there: the
/// computed deviation plus twice the accumulated rounding of z_n (here, and where a ray starts
/// nearby). After each iteration everything is scaled by 1 / (2 |z_k|), the largest growth of a
/// derivative, with a factor of at most 2. Therefore nothing overflows.
DEVICE float3 julia_gradient(GLOBAL const ShapeRecord *julia, float3 p, PRIVATE float *residual) {
    const float escape = julia->z_upper;
    const float modulus = julia_modulus(julia);
    Quaternion z = julia_start(julia, p);
    Quaternion dx, dy, dz;
    dx.real = 1.0f;
    dx.v = make_float3(0.0f, 0.0f, 0.0f);
    dy.real = 0.0f;
    dy.v = make_float3(1.0f, 0.0f, 0.0f);
    dz.real = 0.0f;
    dz.v = make_float3(0.0f, 1.0f, 0.0f);
    float scale = 1.0f;
    float rounding = 0.0f;
    float z2 = quaternion_dot(z, z);
    uint i = 0;
    for (; i < julia->iterations && z2 <= 4.0f * escape * escape; ++i) {
        const float z_length = sqrt(z2);
        const float factor = 0.5f / max(z_length, 0.25f);
        rounding = (2.0f * z_length * rounding + 6.0f * HALF_ULP * (z2 + modulus) * scale) * factor;
        scale *= factor;
        dx = quaternion_anticommutator(dx, z);
        dy = quaternion_anticommutator(dy, z);
        dz = quaternion_anticommutator(dz, z);
        dx.real *= factor;
        dy.real *= factor;
        dz.real *= factor;
        dx.v *= factor;
        dy.v *= factor;
        dz.v *= factor;
        z = julia_next(julia, z);
        z2 = quaternion_dot(z, z);
    }
    const float z_length = sqrt(z2);
    *residual = scale * fabs(z_length - 4.0f) + 2.0f * rounding;
    return make_float3(quaternion_dot(dx, z), quaternion_dot(dy, z), quaternion_dot(dz, z)) /
           z_length;
}
