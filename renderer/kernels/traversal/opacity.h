// SPDX-License-Identifier: MIT
// The opacity test: whether a surface stops a ray that meets it.
//
// A surface of opacity a stops a ray with probability a. All others pass as if it were not there.
// The decision is made where traversal accepts hits. It is a hash of the ray and the primitive, so
// it needs no random generator and does not depend on the order of traversal.
//
// Source: the alpha test of M. Pharr, W. Jakob, G. Humphreys, PBRT 4th ed., section 7.1.1.
// Departure: the primitive is part of the hash, so that surfaces behind each other decide
// independently. The hash is pcg4d of M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering",
// JCGT 9(3), 2020.
#pragma once

#include "renderer/kernels/texture/texel_position.h"
#include "renderer/shared/scene_records.h"

/// The opacities of a scene, and the part of the hash that is the same for all hits of a ray.
typedef struct OpacityTest {
    GLOBAL const uint *triangle_masks;
    GLOBAL const MaskedTriangle *masked_triangles;
    GLOBAL const OpacityRecord *opacities;  ///< null: all surfaces are opaque
    GLOBAL const float *texels;
    uint4 ray;
} OpacityTest;

/// Returns the test of a scene in which all surfaces are opaque.
DEVICE OpacityTest all_opaque(void) {
    OpacityTest test;
    test.triangle_masks = 0;
    test.masked_triangles = 0;
    test.opacities = 0;
    test.texels = 0;
    test.ray = make_uint4(0u, 0u, 0u, 0u);
    return test;
}

/// Returns four words that depend on all bits of four others.
DEVICE uint4 pcg4d(uint4 v) {
    uint x = v.x * 1664525u + 1013904223u, y = v.y * 1664525u + 1013904223u;
    uint z = v.z * 1664525u + 1013904223u, w = v.w * 1664525u + 1013904223u;
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    w ^= w >> 16;
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
    return make_uint4(x, y, z, w);
}

/// Returns the hash of a ray.
DEVICE uint4 hash_of_ray(float3 origin, float3 direction) {
    const uint4 h = pcg4d(
        make_uint4(as_uint(origin.x), as_uint(origin.y), as_uint(origin.z), as_uint(direction.x)));
    return pcg4d(make_uint4(h.x ^ as_uint(direction.y), h.y ^ as_uint(direction.z), h.z, h.w));
}

/// Returns whether a surface of this opacity stops the ray. `hit` numbers the hits of the ray with
/// one primitive. Opacities 0 and 1 are exact; any other is rounded down to a multiple of 2^-32.
DEVICE bool is_stopped(uint4 ray, uint primitive, uint hit, float opacity) {
    if (opacity >= 1.0f) {
        return true;
    }
    const uint4 words = pcg4d(make_uint4(ray.x ^ primitive, ray.y ^ hit, ray.z, ray.w));
    return words.x < (uint)(opacity * 4294967296.0f);
}

/// Returns the texture of an opacity at `uv`.
DEVICE float opacity_texel(GLOBAL const TextureRecord *texture, GLOBAL const float *texels,
                           float2 uv) {
    const uint clamped = texture->flags & TEXTURE_CLAMP;
    const uint width = texture->width, height = texture->height;
    const float2 at = texture_position(texture, uv);
    GLOBAL const float *image = texels + texture->first_word;
    if ((texture->flags & TEXTURE_BILINEAR) == 0u) {
        const uint column = min((uint)(at.x * (float)width), width - 1u);
        const uint row = min((uint)(at.y * (float)height), height - 1u);
        return image[row * width + column];
    }
    // Between texels of 1 the result is exactly 1: 1 - t is rounded by less than half an ulp of 1.
    const TexelPair columns = texel_pair(at.x, width, clamped);
    const TexelPair rows = texel_pair(at.y, height, clamped);
    GLOBAL const float *upper = image + rows.first * width, *lower = image + rows.second * width;
    const float top = upper[columns.first] * (1.0f - columns.t) + upper[columns.second] * columns.t;
    const float bottom =
        lower[columns.first] * (1.0f - columns.t) + lower[columns.second] * columns.t;
    return top * (1.0f - rows.t) + bottom * rows.t;
}

/// Returns the opacity of a material at `uv`.
DEVICE float opacity_at(PRIVATE const OpacityTest *test, uint index, float2 uv) {
    GLOBAL const OpacityRecord *record = test->opacities + index;
    float opacity = record->opacity;
    if (record->texture.width != 0u) {
        opacity *= opacity_texel(&record->texture, test->texels, uv);
    }
    if (record->cutoff > 0.0f) {
        return opacity >= record->cutoff ? 1.0f : 0.0f;
    }
    return opacity;
}

/// Returns whether a triangle stops the ray, which meets it at barycentrics (1 - u - v, u, v).
DEVICE bool triangle_stops(PRIVATE const OpacityTest *test, uint triangle, float u, float v) {
    if (test->opacities == 0) {
        return true;
    }
    const uint mask = test->triangle_masks[triangle];
    if (mask == OPAQUE) {
        return true;
    }
    GLOBAL const MaskedTriangle *masked = test->masked_triangles + mask;
    const float w = 1.0f - u - v;
    const float2 uv =
        make_float2(w * masked->uv[0][0] + u * masked->uv[1][0] + v * masked->uv[2][0],
                    w * masked->uv[0][1] + u * masked->uv[1][1] + v * masked->uv[2][1]);
    return is_stopped(test->ray, triangle, 0u, opacity_at(test, masked->opacity, uv));
}
