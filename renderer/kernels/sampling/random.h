// SPDX-License-Identifier: MIT
// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as
// easy as 1, 2, 3"), from Random123. A number depends only on seed, stream, pixel, sample and
// dimension, not on the work-item that requests it or on the time of the request.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

#include "Random123/philox.h"

// Random streams. Each pass of an algorithm has its own.
#define STREAM_CAMERA 0u
#define STREAM_LIGHT_PATHS 1u

/// Returns the random stream of connections to light `light_index`. Lights that are sampled one
/// after the other have their own.
DEVICE uint light_stream(uint light_index) {
    return light_index == SELECT_LIGHT ? STREAM_CAMERA : 16u + light_index;
}

// Blocks of four random words. Each vertex of a path has two.
#define BLOCK_CAMERA 0u
#define BLOCK_EMISSION(i) (0x80000000u + (i))  // start of a light path
#define BLOCK_LIGHT(depth) (1u + 2u * (depth))
#define BLOCK_SCATTER(depth) (2u + 2u * (depth))

/// Returns four independent uniform 32-bit words. `sample` has 64 bits, because 200k samples per
/// pixel times 65536 pixels times the dimensions of a path exceed 2^32.
DEVICE_LANE uint4 random_words(uint seed, uint stream, uint pixel, ulong sample, uint block) {
    const philox4x32_ctr_t counter = {{pixel, (uint)sample, (uint)(sample >> 32), block}};
    const philox4x32_key_t key = {{seed, stream}};
    const philox4x32_ctr_t words = philox4x32(counter, key);
    return make_uint4(words.v[0], words.v[1], words.v[2], words.v[3]);
}

/// Returns four uniform words of other numbers, which serve as seeds, at two thirds of the cost of
/// random_words: seven rounds, the fewest that pass all tests of the authors.
DEVICE_LANE uint4 seed_words(uint seed, uint stream, uint pixel, ulong sequence, uint block) {
    const philox4x32_ctr_t counter = {{pixel, (uint)sequence, (uint)(sequence >> 32), block}};
    const philox4x32_key_t key = {{seed, stream}};
    const philox4x32_ctr_t words = philox4x32_R(7u, counter, key);
    return make_uint4(words.v[0], words.v[1], words.v[2], words.v[3]);
}

/// Returns a uniform number in [0, 1). It is a multiple of 2^-24, so rounding never gives 1.
DEVICE float uniform_float(uint word) {
    return (float)(word >> 8) * 0x1p-24f;
}
