// SPDX-License-Identifier: MIT
// Sampling of directions and of points on simple domains.
#pragma once

#include "renderer/kernels/math/circle.h"
#include "renderer/shared/compat.h"

/// An orthonormal frame whose z axis is a unit vector.
typedef struct Frame {
    float3 x, y, z;
} Frame;

/// Returns a frame about a unit vector (Duff et al. 2017, "Building an orthonormal basis,
/// revisited"). The division is safe because |z.z + sign| >= 1.
DEVICE Frame frame_from_z(float3 z) {
    const float sign = z.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (sign + z.z);
    const float b = z.x * z.y * a;
    Frame frame;
    frame.x = make_float3(1.0f + sign * z.x * z.x * a, sign * b, -sign * z.x);
    frame.y = make_float3(b, sign + z.y * z.y * a, -z.y);
    frame.z = z;
    return frame;
}

DEVICE float3 to_world(Frame frame, float3 v) {
    return frame.x * v.x + frame.y * v.y + frame.z * v.z;
}

/// Samples a cosine-weighted direction about +z. Density per solid angle: z / pi. For u in [0, 1)
/// in steps of 2^-24, z is at least 2^-12, so the density is never zero.
DEVICE float3 sample_cosine_hemisphere(float u, float v) {
    const float radius = sqrt(u);
    const float2 around = point_on_circle(v);
    return make_float3(radius * around.x, radius * around.y, sqrt(1.0f - u));
}

/// Samples a uniform direction. Density per solid angle: 1 / (4 pi).
DEVICE float3 sample_uniform_sphere(float u, float v) {
    const float z = 1.0f - 2.0f * u;
    const float radius = 2.0f * sqrt(u * (1.0f - u));  // sqrt(1 - z^2), without cancellation
    const float2 around = point_on_circle(v);
    return make_float3(radius * around.x, radius * around.y, z);
}

/// Samples a uniform point of the unit disc. Density per area: 1 / pi.
DEVICE float2 sample_disc(float u, float v) {
    const float radius = sqrt(u);
    const float2 around = point_on_circle(v);
    return make_float2(radius * around.x, radius * around.y);
}

/// Samples uniform barycentrics (b1, b2) of a triangle (Osada et al. 2002). Density per area: 1 /
/// A.
DEVICE float2 sample_triangle(float u, float v) {
    const float root = sqrt(u);
    return make_float2(1.0f - root, v * root);
}

/// Returns x with 1 + erf(x) = w, for w in (0, 2). The relative error is below 1e-6 of 1 + |x|. The
/// approximation is that of M. Giles, "Approximating the erfinv function", 2010. It is written in
/// terms of w, which keeps its digits where erf(x) rounds to -1.
DEVICE float inverse_erf_plus_one(float w) {
    const float y = w - 1.0f;
    float t = -log(w * (2.0f - w));
    float p;
    if (t < 5.0f) {
        t -= 2.5f;
        p = 2.81022636e-08f;
        p = 3.43273939e-07f + p * t;
        p = -3.5233877e-06f + p * t;
        p = -4.39150654e-06f + p * t;
        p = 0.00021858087f + p * t;
        p = -0.00125372503f + p * t;
        p = -0.00417768164f + p * t;
        p = 0.246640727f + p * t;
        p = 1.50140941f + p * t;
    } else {
        t = sqrt(t) - 3.0f;
        p = -0.000200214257f;
        p = 0.000100950558f + p * t;
        p = 0.00134934322f + p * t;
        p = -0.00367342844f + p * t;
        p = 0.00573950773f + p * t;
        p = -0.0076224613f + p * t;
        p = 0.00943887047f + p * t;
        p = 1.00167406f + p * t;
        p = 2.83297682f + p * t;
    }
    return p * y;
}
