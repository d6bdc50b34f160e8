// SPDX-License-Identifier: MIT
// The texels at texture coordinates. (0, 0) is the lower left corner of the image and (1, 1) its
// upper right corner. Rows are stored from the top. Texel centres are at half-integer texel
// coordinates.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

// Some host code is compiled without features. It supports mirrored textures.
#ifdef FEATURE_texture_mirror
#define MIRRORS_TEXTURES FEATURE_texture_mirror
#else
#define MIRRORS_TEXTURES 1
#endif

/// Returns the coordinate in [0, 1] for a lookup at x. For repeated textures, a coordinate whose
/// fraction rounds to 1 gives 0. So does one beyond the range of float, whose fraction is NaN.
DEVICE float texture_wrap(float x, uint clamped) {
    if (clamped != 0u) {
        return x > 0.0f ? min(x, 1.0f) : 0.0f;
    }
    const float fraction = x - floor(x);
    return fraction >= 0.0f && fraction < 1.0f ? fraction : 0.0f;
}

/// Returns the coordinate in [0, 1] for a lookup at x in an image that is mirrored at its edges.
DEVICE float texture_mirror(float x) {
    return fabs(x - 2.0f * floor(0.5f * x + 0.5f));  // the distance from the nearest even number
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
    float x = texture->uv_scale[0] * uv.x + texture->uv_offset[0];
    float y = texture->uv_scale[1] * uv.y + texture->uv_offset[1];
    if (MIRRORS_TEXTURES && (texture->flags & TEXTURE_MIRROR) != 0u) {
        x = texture_mirror(x);
        y = texture_mirror(y);
    }
    return make_float2(texture_wrap(x, clamped), 1.0f - texture_wrap(y, clamped));
}
