// SPDX-License-Identifier: MIT
// The paths at the entries of a queue.
#pragma once

#include "renderer/kernels/stream.h"
#include "renderer/shared/path_state.h"

/// Returns the path in a slot of the stream.
DEVICE Path path_in(Stream stream, uint slot) {
    const Path path = {stream.path_words, stream.capacity, slot};
    return path;
}

/// Prefetches the words of a path.
DEVICE void prefetch_path(Path path) {
    for (uint word = 0u; PREFETCHES && word < PATH_STATE_WORDS; word += CACHE_LINE / 4u) {
        PREFETCH(&PATH_WORD(path, word));
    }
    if (PREFETCHES) {
        PREFETCH(&PATH_WORD(path, PATH_STATE_WORDS - 1u));
    }
}

/// Returns the path at entry i of a queue. For use in FOR_EACH_ENTRY, with i_end as `end`.
/// Prefetches the path three entries ahead: on a CPU its words may be in another core's cache.
DEVICE Path path_at(Stream stream, GLOBAL const uint *queue, uint i, uint end) {
    prefetch_path(path_in(stream, queue[min(i + 3u, end - 1u)]));
    return path_in(stream, queue[i]);
}
