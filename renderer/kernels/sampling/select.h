// SPDX-License-Identifier: MIT
// Discrete selection by 32-bit random words.
//
// Tables store ends: the words from end i - 1 up to, but not including, end i select entry i. Ends
// never decrease. The last end is 2^32 - 1, which represents 2^32. Entries of probability 0 share
// their predecessor's end and are never selected. Probabilities are exactly those of the words, so
// sampling agrees with the densities.
#pragma once

#include "renderer/shared/compat.h"

/// Declares `selected`: the index of the first entry of `table`, from `first` on, whose
/// `selection_end` exceeds `word`.
#define SELECT_BY_WORD(table, member, first, count, word, selected) \
    uint selected = (first);                                        \
    {                                                               \
        uint remaining = (count)-1u;                                \
        while (remaining > 0u) {                                    \
            const uint half_ = (remaining + 1u) / 2u;               \
            if ((table)[selected + half_ - 1u] member <= (word)) {  \
                selected += half_;                                  \
                remaining -= half_;                                 \
            } else {                                                \
                remaining = half_ - 1u;                             \
            }                                                       \
        }                                                           \
    }

/// The words that select an entry of a table: [begin, begin + count).
typedef struct WordRange {
    uint begin;
    float count;
} WordRange;

/// Returns the words that select entry `i` of a table of `count` entries from `first` on.
DEVICE WordRange selection_range(GLOBAL const uint *ends, uint first, uint count, uint i) {
    WordRange range;
    range.begin = i == first ? 0u : ends[i - 1u];
    // The difference of two words is exact; its conversion to float has a relative rounding error.
    // The last end is 2^32, which is 0 in the arithmetic of words.
    const bool is_last = i + 1u == first + count;
    const uint words = (is_last ? 0u : ends[i]) - range.begin;
    range.count = is_last && range.begin == 0u ? 4294967296.0f : (float)words;
    return range;
}
