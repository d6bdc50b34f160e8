// SPDX-License-Identifier: MIT
// One digit of a stable radix sort: count_digits and move_by_digit, with one work-item per chunk of
// keys, and prefix sums of the counts in between.
//
// Source: N. Satish, M. Harris, M. Garland, "Designing Efficient Sorting Algorithms for Manycore
// GPUs", IPDPS 2009, with work-items instead of thread blocks. Counts are ordered by digit, then by
// chunk; their sums are the positions of each chunk's keys. The sort is stable, so its result does
// not depend on the size of a chunk. RADIX_BITS is the number of bits of a digit.
#include "renderer/shared/compat.h"

#define RADIX_DIGITS (1u << RADIX_BITS)

static uint digit_of(ulong key, uint shift) {
    return (uint)(key >> shift) & (RADIX_DIGITS - 1u);
}

__kernel void count_digits(GLOBAL const ulong *keys, uint count, uint shift, uint chunk_size,
                           uint chunk_count, GLOBAL uint *counts) {
    const uint chunk = (uint)get_global_id(0);
    if (chunk >= chunk_count) {
        return;
    }
    uint found[RADIX_DIGITS];
    for (uint digit = 0; digit < RADIX_DIGITS; ++digit) {
        found[digit] = 0;
    }
    const uint end = min((chunk + 1u) * chunk_size, count);
    for (uint i = chunk * chunk_size; i < end; ++i) {
        found[digit_of(keys[i], shift)] += 1u;
    }
    for (uint digit = 0; digit < RADIX_DIGITS; ++digit) {
        counts[digit * chunk_count + chunk] = found[digit];
    }
}

__kernel void move_by_digit(GLOBAL const ulong *keys, GLOBAL const uint *values, uint count,
                            uint shift, uint chunk_size, uint chunk_count,
                            GLOBAL const uint *places, GLOBAL ulong *sorted_keys,
                            GLOBAL uint *sorted_values) {
    const uint chunk = (uint)get_global_id(0);
    if (chunk >= chunk_count) {
        return;
    }
    uint next[RADIX_DIGITS];
    for (uint digit = 0; digit < RADIX_DIGITS; ++digit) {
        next[digit] = places[digit * chunk_count + chunk];
    }
    const uint end = min((chunk + 1u) * chunk_size, count);
    for (uint i = chunk * chunk_size; i < end; ++i) {
        const ulong key = keys[i];
        const uint digit = digit_of(key, shift);
        const uint place = next[digit];
        next[digit] = place + 1u;
        sorted_keys[place] = key;
        sorted_values[place] = values[i];
    }
}
