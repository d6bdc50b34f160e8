// SPDX-License-Identifier: MIT
// Guided emission: tables of the directions in which light paths leave a light, and of the lights.
//
// A light with a table has a density g over the unit square of two random numbers (u, v), constant
// in each bin (shared/emission_guide.h) and with mean 1. The square stands for the directions of
// unguided emission:
// - Flat lights: the hemisphere about the axis z of the light, in proportion to the cosine. The
//   point of the surface is independent of the direction.
// - Spheres: all directions, in world axes. The point is uniform on the silhouette in that
//   direction. A sphere of uniform radiance emits its rays so.
// - Point lights: all directions, in world axes.
//
// In all of them p_o p_d of MIS (4) is g times the value of unguided emission. For spheres the
// split of this product is a formality: p_o is kept, and p_d has the factor g.
//
// g is a ratio of numbers of random words, so the density is exactly that of the sampling. The
// position of a word in its range is the position in the bin, so stratified words stay stratified.
// A flat table thus keeps the directions that there are without a table, except those of spheres.
//
// The bin of a direction that comes from elsewhere is found by inversion. If rounding puts a
// direction next to the edge of a bin into the neighbour, the densities of two strategies disagree
// for it. Such directions have a relative measure of some 2^-20, the number of bins across times
// the rounding error of u and v.
#pragma once

#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/sampling/select.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/emission_guide.h"
#include "renderer/shared/scene_records.h"

/// A bin of a light's table.
typedef struct GuideBin {
    uint row, column;
} GuideBin;

/// A sampled point of the unit square.
typedef struct GuideSample {
    float u, v;     ///< multiples of 2^-24 in [0, 1)
    float density;  ///< g
} GuideSample;

/// Returns whether emission is guided.
DEVICE bool is_guided(PRIVATE const SceneView *scene) {
    return FEATURE_guided_emission && scene->emission_guide;
}

/// Returns whether a light, as `light_at` returns it, has a table.
DEVICE bool has_guide_table(LightRecord light) {
    return FEATURE_guided_emission && light.guide_table != NO_GUIDE_TABLE;
}

/// Returns the record of a light. If emission is guided, `emission_selection` and `guide_table` are
/// those of the guide.
DEVICE LightRecord light_at(PRIVATE const SceneView *scene, uint index) {
    LightRecord light = scene->lights[index];
    if (is_guided(scene)) {
        const uint count = scene->lighting.light_count;
        light.emission_selection =
            selection_range(scene->emission_guide, 0u, count, index).count * 0x1p-32f;
        light.guide_table = scene->emission_guide[count + index];
    }
    return light;
}

/// Returns g in a bin of a light that has a table.
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

/// Returns the bin of the table of a light with direction `d` (unit, away from the light). For flat
/// lights, `d` is on the side that emits.
DEVICE GuideBin guide_bin(LightRecord light, float3 d) {
    float u, x, y;
    if (light.kind <= LIGHT_DISC) {
        x = light.axis_x[0] * d.x + light.axis_x[1] * d.y + light.axis_x[2] * d.z;
        y = light.axis_y[0] * d.x + light.axis_y[1] * d.y + light.axis_y[2] * d.z;
        u = x * x + y * y;
    } else {
        x = d.x;
        y = d.y;
        u = 0.5f - 0.5f * d.z;
    }
    const float turn = atan2(y, x) * (0.5f * INV_PI);
    GuideBin bin;
    bin.row = guide_part(u, GUIDE_ROWS);
    bin.column = guide_part(turn < 0.0f ? turn + 1.0f : turn, GUIDE_COLUMNS);
    return bin;
}

/// Returns g of a light in direction `d`, as in `guide_bin`; 1 if the light has no table.
DEVICE float guide_density(PRIVATE const SceneView *scene, LightRecord light, float3 d) {
    return has_guide_table(light)
               ? guide_bin_density(scene->emission_guide, light.guide_table, guide_bin(light, d))
               : 1.0f;
}

/// Returns the position of `word` in the range that selects entry `i` of a table of ends, as an
/// integer below 2^bits. In a range of 2^m words these are the upper bits of the position.
DEVICE uint position_in_range(GLOBAL const uint *ends, uint first, uint count, uint i, uint word,
                              uint bits) {
    const uint begin = i == first ? 0u : ends[i - 1u];
    const ulong end = i + 1u == first + count ? (ulong)1 << 32 : (ulong)ends[i];
    return (uint)(((ulong)(word - begin) << bits) / (end - begin));
}

/// Samples a point of a light's unit square from a word for u and one for v.
DEVICE GuideSample sample_guide(PRIVATE const SceneView *scene, LightRecord light, uint word_u,
                                uint word_v) {
    GuideSample sample;
    if (!has_guide_table(light)) {
        sample.u = uniform_float(word_u);
        sample.v = uniform_float(word_v);
        sample.density = 1.0f;
        return sample;
    }
    GLOBAL const uint *guide = scene->emission_guide;
    const uint table = light.guide_table;
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
