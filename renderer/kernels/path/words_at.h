// SPDX-License-Identifier: MIT
// The random words of the paths at the entries of the active queue.
#pragma once

#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/sampling/word_batch.h"

/// Returns the words of block `first_block` + 2 depth of the path at entry i, in a FOR_EACH_ENTRY
/// that ends at `end`. Draws those of the next entries with them.
DEVICE uint4 words_at(PRIVATE WordBatch *batch, Stream stream, uint i, uint end,
                      IntegratorSettings settings, uint random_stream, ulong first_sample,
                      uint first_block) {
    const uint place = i % STREAM_CHUNK % WORD_BATCH;
    if (place == 0u) {
        WordRequests requests;
        for (uint k = 0u; k < WORD_BATCH; ++k) {
            const Path path = path_in(stream, active_queue(stream)[min(i + k, end - 1u)]);
            requests.pixel[k] = get_pixel(path);
            requests.sample[k] = get_sample(path);
            requests.block[k] = first_block + 2u * get_depth(path);
        }
        draw_words(batch, &requests, settings, random_stream, first_sample);
    }
    return words_in(batch, place);
}

/// Returns the words of BLOCK_LIGHT of the path at entry i, as words_at.
DEVICE uint4 light_words_at(PRIVATE WordBatch *batch, Stream stream, uint i, uint end,
                            IntegratorSettings settings, ulong first_sample, uint light_index) {
    return words_at(batch, stream, i, end, settings, light_stream(light_index), first_sample,
                    BLOCK_LIGHT(0u));
}

/// Returns the words of BLOCK_SCATTER of the path at entry i, as words_at.
DEVICE uint4 scatter_words_at(PRIVATE WordBatch *batch, Stream stream, uint i, uint end,
                              IntegratorSettings settings, ulong first_sample) {
    return words_at(batch, stream, i, end, settings, STREAM_CAMERA, first_sample,
                    BLOCK_SCATTER(0u));
}
