// SPDX-License-Identifier: MIT
// Lookups of colours in textures.
#pragma once

#include "renderer/kernels/texture/srgb_table.h"
#include "renderer/kernels/texture/texel_position.h"

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

DEVICE float rec709_luminance(float3 colour) {
    return dot(colour, make_float3(0.2126f, 0.7152f, 0.0722f));
}

/// Returns the derivatives of the luminance by u and v at `uv`. They are zero for a texture of the
/// nearest texel.
DEVICE float2 texture_gradient(GLOBAL const TextureRecord *texture, GLOBAL const uint *texels,
                               float2 uv) {
    if ((texture->flags & TEXTURE_BILINEAR) == 0u) {
        return make_float2(0.0f, 0.0f);
    }
    const uint clamped = texture->flags & TEXTURE_CLAMP;
    const uint width = texture->width, height = texture->height;
    const float2 at = texture_position(texture, uv);
    const TexelPair columns = texel_pair(at.x, width, clamped);
    const TexelPair rows = texel_pair(at.y, height, clamped);
    const uint upper = rows.first * width, lower = rows.second * width;
    const float upper_left =
        rec709_luminance(texture_texel(texture, texels, upper + columns.first));
    const float upper_right =
        rec709_luminance(texture_texel(texture, texels, upper + columns.second));
    const float lower_left =
        rec709_luminance(texture_texel(texture, texels, lower + columns.first));
    const float lower_right =
        rec709_luminance(texture_texel(texture, texels, lower + columns.second));
    const float by_column =
        (upper_right - upper_left) * (1.0f - rows.t) + (lower_right - lower_left) * rows.t;
    const float by_row =
        (lower_left - upper_left) * (1.0f - columns.t) + (lower_right - upper_right) * columns.t;
    // Rows run from the top, against v.
    return make_float2(by_column * (float)width * texture->uv_scale[0],
                       -by_row * (float)height * texture->uv_scale[1]);
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
