// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/shared/compat.h"

/// An orthonormal frame whose z axis is a unit vector.
typedef struct Frame {
    float3 x, y, z;
} Frame;

/// Duff et al. 2017, "Building an orthonormal basis, revisited": |z.z + sign| >= 1, so the division is safe.
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

DEVICE float3 to_world(Frame frame, float3 v) { return frame.x * v.x + frame.y * v.y + frame.z * v.z; }

/// Cosine-weighted direction about +z. Density per solid angle: z / pi. With u in [0, 1) in steps of 2^-24, z is
/// at least 2^-12: the density is never zero.
DEVICE float3 sample_cosine_hemisphere(float u, float v) {
    const float radius = sqrt(u);
    return make_float3(radius * cospi(2.0f * v), radius * sinpi(2.0f * v), sqrt(1.0f - u));
}

/// Uniform barycentrics (b1, b2) of a triangle; density per area 1 / A. Osada et al. 2002.
DEVICE float2 sample_triangle(float u, float v) {
    const float root = sqrt(u);
    return make_float2(1.0f - root, v * root);
}
