// SPDX-License-Identifier: MIT
// Texture lookups. (0, 0) is the lower left corner of the image and (1, 1) its upper right corner.
// Rows are stored from the top. Texel centres are at half-integer texel coordinates.
#pragma once

#include "renderer/kernels/texture/srgb_table.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns the linear colour of texel `index`, counted row by row.
DEVICE float3 texture_texel(GLOBAL const TextureRecord *texture, GLOBAL const uint *texels,
                            uint index) {
    if ((texture->flags & TEXTURE_FLOAT) != 0u) {
        GLOBAL const uint *words = texels + texture->first_word + 3u * index;
        return make_float3(as_float(words[0]), as_float(words[1]), as_float(words[2]));
    }
    const uint word = texels[texture->first_word + index];
    const uint r = word & 255u, g = (word >> 8) & 255u, b = (word >> 16) & 255u;
    if ((texture->flags & TEXTURE_SRGB) != 0u) {
        return make_float3(srgb_to_linear[r], srgb_to_linear[g], srgb_to_linear[b]);
    }
    return make_float3((float)r, (float)g, (float)b) / 255.0f;
}

/// Returns the coordinate in [0, 1] for a lookup at x. For repeated textures, a coordinate whose
/// fraction rounds to 1 gives 0. So does one beyond the range of float, whose fraction is NaN.
DEVICE float texture_wrap(float x, uint clamped) {
    if (clamped != 0u) {
        return x > 0.0f ? min(x, 1.0f) : 0.0f;
    }
    const float fraction = x - floor(x);
    return fraction >= 0.0f && fraction < 1.0f ? fraction : 0.0f;
}

/// Neighbouring texels along one axis, and the position `t` of the lookup between them.
typedef struct TexelPair {
    uint first, second;
    float t;
} TexelPair;

/// Returns the texels around `x` in [0, 1].
DEVICE TexelPair texel_pair(float x, uint size, uint clamped) {
    const float position = x * (float)size - 0.5f;  // at least -1/2, at most size - 1/2
    const float below = floor(position);
    const int i = (int)below;
    const int last = (int)size - 1;
    TexelPair pair;
    pair.t = position - below;
    pair.first = (uint)(i >= 0 ? i : clamped != 0u ? 0 : last);
    pair.second = (uint)(i < last ? i + 1 : clamped != 0u ? last : 0);
    return pair;
}

/// Returns the position of `uv` in the image, where (0, 0) is the upper left corner and (1, 1) the
/// lower right corner.
DEVICE float2 texture_position(GLOBAL const TextureRecord *texture, float2 uv) {
    const uint clamped = texture->flags & TEXTURE_CLAMP;
    return make_float2(
        texture_wrap(texture->uv_scale[0] * uv.x + texture->uv_offset[0], clamped),
        1.0f - texture_wrap(texture->uv_scale[1] * uv.y + texture->uv_offset[1], clamped));
}

/// Returns the linear colour at `uv`.
DEVICE float3 texture_lookup(GLOBAL const TextureRecord *texture, GLOBAL const uint *texels,
                             float2 uv) {
    const uint clamped = texture->flags & TEXTURE_CLAMP;
    const uint width = texture->width, height = texture->height;
    const float2 at = texture_position(texture, uv);
    if ((texture->flags & TEXTURE_BILINEAR) == 0u) {
        const uint column = min((uint)(at.x * (float)width), width - 1u);
        const uint row = min((uint)(at.y * (float)height), height - 1u);
        return texture_texel(texture, texels, row * width + column);
    }
    const TexelPair columns = texel_pair(at.x, width, clamped);
    const TexelPair rows = texel_pair(at.y, height, clamped);
    const float3 top =
        texture_texel(texture, texels, rows.first * width + columns.first) * (1.0f - columns.t) +
        texture_texel(texture, texels, rows.first * width + columns.second) * columns.t;
    const float3 bottom =
        texture_texel(texture, texels, rows.second * width + columns.first) * (1.0f - columns.t) +
        texture_texel(texture, texels, rows.second * width + columns.second) * columns.t;
    return top * (1.0f - rows.t) + bottom * rows.t;
}
