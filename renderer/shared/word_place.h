// SPDX-License-Identifier: MIT
// Locations and access of records stored beside the path states, with a row of them for each path.
// The words of a record are contiguous if those of a path are (path_state.h).
#pragma once

#include "compat.h"

#ifdef __OPENCL_VERSION__

/// Location of a record: word w is at first[w * stride].
typedef struct WordPlace {
    GLOBAL uint *first;
    ulong stride;
} WordPlace;

/// Returns the location of record `i` in row `row`, with `per_row` records per row and `rows` rows.
/// There may be more than 2^32 words.
DEVICE WordPlace record_place(GLOBAL uint *words, uint record_words, uint rows, uint per_row,
                              uint row, uint i) {
    WordPlace place;
#if PATH_STATE_INTERLEAVED
    place.first = words + ((ulong)row * per_row + i) * record_words;
    place.stride = 1;
    (void)rows;
#else
    place.first = words + (ulong)i * record_words * rows + row;
    place.stride = rows;
    (void)per_row;
#endif
    return place;
}

DEVICE uint load_uint(WordPlace place, uint word) {
    return place.first[word * place.stride];
}
DEVICE float load_float(WordPlace place, uint word) {
    return as_float(load_uint(place, word));
}
DEVICE float3 load_float3(WordPlace place, uint word) {
    return make_float3(load_float(place, word), load_float(place, word + 1),
                       load_float(place, word + 2));
}

DEVICE void store_uint(WordPlace place, uint word, uint value) {
    place.first[word * place.stride] = value;
}
DEVICE void store_float(WordPlace place, uint word, float value) {
    store_uint(place, word, as_uint(value));
}
DEVICE void store_float3(WordPlace place, uint word, float3 value) {
    store_float(place, word, value.x);
    store_float(place, word + 1, value.y);
    store_float(place, word + 2, value.z);
}

#endif
