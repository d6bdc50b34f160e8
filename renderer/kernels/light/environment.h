// SPDX-License-Identifier: MIT
// Radiance from infinity by a latitude-longitude image, and its sampling.
//
// The image is bilinear between texel centres. Directions are therefore divided into cells whose
// corners are texel centres: `width` columns and `height` + 1 rows. The first and last row are half
// cells at the poles, and rows beyond the image repeat the nearest row. A cell is selected in
// proportion to the mean of its corners times its solid angle, first its row, then its column.
// Within a cell, directions are uniform per solid angle. A cell has probability 0 only if its
// radiance is 0.
#pragma once

#include "renderer/kernels/math/circle.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/sampling/select.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Position of a direction (in light space, unit): the cell, and the position in it from its left
/// and upper edge.
typedef struct EnvironmentPosition {
    uint column, row;
    float x, y;
} EnvironmentPosition;

/// Returns the position of direction d in the cells.
DEVICE EnvironmentPosition environment_position(LightingRecord lighting, float3 d) {
    // Unlike acos, atan2 is exact to rounding near the poles, too.
    float u = atan2(d.x, -d.z) * (0.5f * INV_PI);
    u = u < 0.0f ? u + 1.0f : u;
    const float v = atan2(sqrt(d.x * d.x + d.z * d.z), d.y) * INV_PI;
    const float width = (float)lighting.environment_width;
    const float x = u * width + (width - 0.5f);  // from the centre of texel 0, plus one turn
    const float y = v * (float)lighting.environment_height + 0.5f;
    EnvironmentPosition position;
    position.column = (uint)x % lighting.environment_width;
    position.x = x - floor(x);
    position.row = min((uint)y, lighting.environment_height);
    position.y = y - (float)position.row;
    return position;
}

/// Returns the texel of a column at the upper edge of a row of cells.
DEVICE float3 environment_texel(GLOBAL const float *texels, LightingRecord lighting, uint column,
                                uint row) {
    // Row r of cells is below texel r - 1.
    GLOBAL const float *texel =
        texels + 3u * ((row - min(row, 1u)) * lighting.environment_width + column);
    return make_float3(texel[0], texel[1], texel[2]);
}

/// Returns the radiance from direction d, divided by the light's factor.
DEVICE float3 environment_radiance(GLOBAL const float *texels, LightingRecord lighting, float3 d) {
    const EnvironmentPosition at = environment_position(lighting, d);
    const uint right = at.column + 1u == lighting.environment_width ? 0u : at.column + 1u;
    const uint below = min(at.row + 1u, lighting.environment_height);
    const float3 upper = environment_texel(texels, lighting, at.column, at.row) * (1.0f - at.x) +
                         environment_texel(texels, lighting, right, at.row) * at.x;
    const float3 lower = environment_texel(texels, lighting, at.column, below) * (1.0f - at.x) +
                         environment_texel(texels, lighting, right, below) * at.x;
    return upper * (1.0f - at.y) + lower * at.y;
}

/// Returns v at the upper edge of a row of cells.
DEVICE float row_edge(LightingRecord lighting, uint row) {
    if (row == 0u) {
        return 0.0f;
    }
    return row > lighting.environment_height
               ? 1.0f
               : ((float)row - 0.5f) / (float)lighting.environment_height;
}

/// Returns the solid angle of a cell in a row: 2 pi / width (cos(pi v0) - cos(pi v1)). The product
/// of sines avoids cancellation.
DEVICE float cell_solid_angle(LightingRecord lighting, uint row) {
    const float v0 = row_edge(lighting, row);
    const float v1 = row_edge(lighting, row + 1u);
    return 4.0f * PI / (float)lighting.environment_width * sinpi(0.5f * (v0 + v1)) *
           sinpi(0.5f * (v1 - v0));
}

/// Returns the density per solid angle of `sample_environment` in a cell.
DEVICE float cell_pdf_w(GLOBAL const uint *ends, LightingRecord lighting, uint column, uint row) {
    const uint rows = lighting.environment_height + 1u;
    const uint width = lighting.environment_width;
    const float row_words = selection_range(ends, 0u, rows, row).count;
    const float column_words =
        selection_range(ends, rows + row * width, width, rows + row * width + column).count;
    return (row_words * 0x1p-32f) * (column_words * 0x1p-32f) / cell_solid_angle(lighting, row);
}

/// Returns the density per solid angle of `sample_environment` in direction d.
DEVICE float environment_pdf_w(GLOBAL const uint *ends, LightingRecord lighting, float3 d) {
    const EnvironmentPosition at = environment_position(lighting, d);
    return cell_pdf_w(ends, lighting, at.column, at.row);
}

/// A sampled direction of the environment.
typedef struct EnvironmentSample {
    float3 direction;  ///< light space, unit, towards the environment
    float pdf_w;
} EnvironmentSample;

/// Samples a direction from the last three words.
DEVICE EnvironmentSample sample_environment(GLOBAL const uint *ends, LightingRecord lighting,
                                            uint4 words) {
    const uint rows = lighting.environment_height + 1u;
    const uint width = lighting.environment_width;
    SELECT_BY_WORD(ends, , 0u, rows, words.y, row)
    const uint first = rows + row * width;
    SELECT_BY_WORD(ends, , first, width, words.z, entry)
    const uint column = entry - first;
    // The position of the word in the column's range is uniform, too.
    const WordRange range = selection_range(ends, first, width, entry);
    const float x = min((float)(words.z - range.begin) / range.count, 0x1.fffffep-1f);
    const float u = ((float)column + 0.5f + x) / (float)width;
    // Uniform in cos(theta) = cos(pi v) between the edges. Near a pole 1 - cos(theta) would lose
    // its digits. The interpolation therefore uses sin^2(theta / 2) = (1 - cos(theta)) / 2,
    // measured from the nearer pole.
    const float v0 = row_edge(lighting, row), v1 = row_edge(lighting, row + 1u);
    const float south = v0 + v1 > 1.0f ? 1.0f : 0.0f;
    const float s0 = sinpi(0.5f * (south > 0.0f ? 1.0f - v0 : v0)),
                s1 = sinpi(0.5f * (south > 0.0f ? 1.0f - v1 : v1));
    const float y = uniform_float(words.w);
    // sin^2(theta / 2), at most about 1/2.
    const float square = s0 * s0 + y * (s1 * s1 - s0 * s0);
    const float sin_theta = 2.0f * sqrt(square * (1.0f - square));
    const float cos_theta = 1.0f - 2.0f * square;
    EnvironmentSample sample;
    const float2 around = point_on_circle(u);
    sample.direction = make_float3(sin_theta * around.y, south > 0.0f ? -cos_theta : cos_theta,
                                   -sin_theta * around.x);
    sample.pdf_w = cell_pdf_w(ends, lighting, column, row);
    return sample;
}
