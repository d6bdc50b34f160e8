// SPDX-License-Identifier: MIT
// Tables of directions (shared/guide_layout.h): densities g over the unit square of two random
// numbers (u, v), constant in each bin and with mean 1.
//
// g is a ratio of numbers of random words, so the density is exactly that of the sampling. The
// position of a word in its range is the position in the bin, so stratified words stay stratified.
//
// The bin of a direction that comes from elsewhere is found by inversion. If rounding puts a
// direction next to the edge of a bin into the neighbour, the densities of two strategies disagree
// for it. Such directions have a relative measure of some 2^-20, the number of bins across times
// the rounding error of u and v.
#pragma once

#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/sampling/select.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/guide_layout.h"

/// A bin of a table.
typedef struct GuideBin {
    uint row, column;
} GuideBin;

/// A sampled point of the unit square.
typedef struct GuideSample {
    float u, v;     ///< multiples of 2^-24 in [0, 1)
    float density;  ///< g
} GuideSample;

/// Returns g in a bin of a table.
DEVICE float guide_bin_density(GLOBAL const uint *guide, uint table, GuideBin bin) {
    const uint columns = table + GUIDE_ROWS + bin.row * GUIDE_COLUMNS;
    const float row_words = selection_range(guide, table, GUIDE_ROWS, table + bin.row).count;
    const float column_words =
        selection_range(guide, columns, GUIDE_COLUMNS, columns + bin.column).count;
    return (row_words * (GUIDE_ROWS * 0x1p-32f)) * (column_words * (GUIDE_COLUMNS * 0x1p-32f));
}

/// Returns the index below `count` of the part of [0, 1] with x. For a NaN, and beyond the ends, it
/// is the last.
DEVICE uint guide_part(float x, uint count) {
    const float scaled = x * (float)count;
    return scaled >= 0.0f && scaled < (float)count ? (uint)scaled : count - 1u;
}

/// Returns the bin of a point of the square, from u and a vector (x, y) whose angle is 2 pi v.
DEVICE GuideBin bin_of_turn(float u, float x, float y) {
    const float turn = atan2(y, x) * (0.5f * INV_PI);
    GuideBin bin;
    bin.row = guide_part(u, GUIDE_ROWS);
    bin.column = guide_part(turn < 0.0f ? turn + 1.0f : turn, GUIDE_COLUMNS);
    return bin;
}

/// Returns the bin of direction `d` (unit) in a table over all directions.
DEVICE GuideBin sphere_bin(float3 d) {
    return bin_of_turn(0.5f - 0.5f * d.z, d.x, d.y);
}

/// Returns the position of `word` in the range that selects entry `i` of a table of ends, as an
/// integer below 2^bits. In a range of 2^m words these are the upper bits of the position.
DEVICE uint position_in_range(GLOBAL const uint *ends, uint first, uint count, uint i, uint word,
                              uint bits) {
    const uint begin = i == first ? 0u : ends[i - 1u];
    const ulong end = i + 1u == first + count ? (ulong)1 << 32 : (ulong)ends[i];
    return (uint)(((ulong)(word - begin) << bits) / (end - begin));
}

/// Samples a point of the unit square from a table, by a word for u and one for v.
DEVICE GuideSample sample_table(GLOBAL const uint *guide, uint table, uint word_u, uint word_v) {
    GuideSample sample;
    SELECT_BY_WORD(guide, , table, GUIDE_ROWS, word_u, row_entry)
    const uint row = row_entry - table;
    const uint columns = table + GUIDE_ROWS + row * GUIDE_COLUMNS;
    SELECT_BY_WORD(guide, , columns, GUIDE_COLUMNS, word_v, column_entry)
    const uint column = column_entry - columns;
    const uint in_row = position_in_range(guide, table, GUIDE_ROWS, row_entry, word_u,
                                          24u - GUIDE_ROW_BITS),
               in_column = position_in_range(guide, columns, GUIDE_COLUMNS, column_entry, word_v,
                                             24u - GUIDE_COLUMN_BITS);
    sample.u = (float)((row << (24u - GUIDE_ROW_BITS)) + in_row) * 0x1p-24f;
    sample.v = (float)((column << (24u - GUIDE_COLUMN_BITS)) + in_column) * 0x1p-24f;
    GuideBin bin;
    bin.row = row;
    bin.column = column;
    sample.density = guide_bin_density(guide, table, bin);
    return sample;
}
