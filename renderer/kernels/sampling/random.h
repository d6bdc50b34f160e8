// SPDX-License-Identifier: MIT
// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as
// easy as 1, 2, 3"), from Random123. A number depends on seed, stream, pixel, sample and dimension
// alone, never on which work-item asks for it or when.
#pragma once

#include "renderer/shared/compat.h"

#include "Random123/philox.h"

// Streams keep the passes of an algorithm apart.
#define STREAM_CAMERA 0u
#define STREAM_LIGHT_PATHS 1u
#define STREAM_LIGHT(light) \
    (16u + (light))  // light `light` where all are sampled one after the other

// Blocks of four random words. Each vertex of a path owns two.
#define BLOCK_CAMERA 0u
#define BLOCK_EMISSION(i) (0x80000000u + (i))  // of a light path: its start
#define BLOCK_LIGHT(depth) (1u + 2u * (depth))
#define BLOCK_SCATTER(depth) (2u + 2u * (depth))

/// Four independent uniform 32-bit words. `sample` takes the full 64 bits: 200k spp times 65536
/// pixels times the dimensions of a path exceeds 2^32.
DEVICE uint4 random_words(uint seed, uint stream, uint pixel, ulong sample, uint block) {
    const philox4x32_ctr_t counter = {{pixel, (uint)sample, (uint)(sample >> 32), block}};
    const philox4x32_key_t key = {{seed, stream}};
    const philox4x32_ctr_t words = philox4x32(counter, key);
    return make_uint4(words.v[0], words.v[1], words.v[2], words.v[3]);
}

/// Uniform in [0, 1): a multiple of 2^-24, so that 1 is never reached by rounding.
DEVICE float uniform_float(uint word) {
    return (float)(word >> 8) * 0x1p-24f;
}
