// SPDX-License-Identifier: MIT
// The random words of several paths, drawn together.
//
// Sobol points take many integer operations without branches: for one path after the other, a sixth
// of a render's time. On a CPU a work-item has many paths. It draws the words of the next ones in
// loops over arrays, which the compiler turns into vector instructions. On a GPU a batch has one
// path, and so it has for independent words, where vectors gain nothing.
#pragma once

#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/stream.h"

/// Number of paths whose words are drawn together.
#define WORD_BATCH (FEATURE_sobol && STREAM_CHUNK >= 16u ? 16u : 1u)

/// The paths whose words are drawn, and the block of each.
typedef struct WordRequests {
    uint pixel[WORD_BATCH];   ///< in a light pass: the index of the path within its sample
    uint sample[WORD_BATCH];  ///< in the batch of samples
    uint block[WORD_BATCH];
} WordRequests;

/// The words of the paths: component by component, so that neighbours are of neighbouring paths.
typedef struct WordBatch {
    uint x[WORD_BATCH], y[WORD_BATCH], z[WORD_BATCH], w[WORD_BATCH];
} WordBatch;

DEVICE_LANE uint4 words_in(PRIVATE const WordBatch *batch, uint i) {
    return make_uint4(batch->x[i], batch->y[i], batch->z[i], batch->w[i]);
}

DEVICE_LANE void set_words(PRIVATE WordBatch *batch, uint i, bool is_new, uint4 words) {
    batch->x[i] = is_new ? words.x : batch->x[i];
    batch->y[i] = is_new ? words.y : batch->y[i];
    batch->z[i] = is_new ? words.z : batch->z[i];
    batch->w[i] = is_new ? words.w : batch->w[i];
}

DEVICE_LANE WordSource source_of(PRIVATE const WordRequests *requests, uint i,
                                 IntegratorSettings settings, uint stream, ulong first_sample) {
    return path_source(settings, stream, requests->pixel[i], first_sample + requests->sample[i]);
}

/// Draws the words of all requests.
DEVICE_LANE void draw_words(PRIVATE WordBatch *batch, PRIVATE const WordRequests *requests,
                            IntegratorSettings settings, uint stream, ulong first_sample) {
    if (has_regular_words(settings)) {
        for (uint i = 0u; i < WORD_BATCH; ++i) {
            const WordSource source = source_of(requests, i, settings, stream, first_sample);
            set_words(batch, i, true, regular_words(source, requests->block[i]));
        }
        return;
    }
    uint sobol_blocks = 0u;
    for (uint i = 0u; i < WORD_BATCH; ++i) {
        sobol_blocks += is_sobol_block(settings, requests->block[i]) ? 1u : 0u;
    }
    if (sobol_blocks < WORD_BATCH) {
        for (uint i = 0u; i < WORD_BATCH; ++i) {
            const WordSource source = source_of(requests, i, settings, stream, first_sample);
            set_words(batch, i, true, independent_words(settings.seed, source, requests->block[i]));
        }
    }
    if (sobol_blocks > 0u) {
        for (uint i = 0u; i < WORD_BATCH; ++i) {
            const WordSource source = source_of(requests, i, settings, stream, first_sample);
            set_words(batch, i, is_sobol_block(settings, requests->block[i]),
                      sobol_words(settings.seed, source, requests->block[i]));
        }
    }
}
