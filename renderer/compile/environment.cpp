// SPDX-License-Identifier: MIT
// Compiles environment images into texels and selection tables.
#include <algorithm>
#include <cmath>

#include "renderer/compile/compile_scene.h"

#include "renderer/base/angles.h"

namespace rtrays {

double compile_environment(const TextureImage &image, CompiledScene &compiled) {
    const auto width = static_cast<size_t>(image.width);
    const auto height = static_cast<size_t>(image.height);
    const auto mean = [&](size_t column, size_t row) {
        const float *texel = image.floats.data() + 3 * (row * width + column % width);
        return (static_cast<double>(texel[0]) + static_cast<double>(texel[1]) +
                static_cast<double>(texel[2])) /
               3.0;
    };
    const auto edge = [&](size_t row) {
        return row == 0       ? 0.0
               : row > height ? 1.0
                              : (static_cast<double>(row) - 0.5) / static_cast<double>(height);
    };
    std::vector<double> rows;
    std::vector<uint32_t> columns;
    for (size_t row = 0; row <= height; ++row) {
        // Row `row` of cells is between texel rows row - 1 and row.
        const size_t above = row == 0 ? 0 : row - 1;
        const size_t below = std::min(row, height - 1);
        const double solid_angle = 2.0 * pi / static_cast<double>(width) *
                                   (std::cos(pi * edge(row)) - std::cos(pi * edge(row + 1)));
        std::vector<double> cells(width);
        double sum = 0;
        for (size_t column = 0; column < width; ++column) {
            cells[column] = 0.25 * (mean(column, above) + mean(column + 1, above) +
                                    mean(column, below) + mean(column + 1, below));
            sum += cells[column] * solid_angle;
        }
        rows.push_back(sum);
        if (sum == 0.0) {
            // This row is never selected, but its table must still be valid.
            std::fill(cells.begin(), cells.end(), 1.0);
        }
        const SelectionTable table = selection_table(cells);
        columns.insert(columns.end(), table.end.begin(), table.end.end());
    }
    double integral = 0;
    for (const double row : rows) {
        integral += row;
    }
    if (integral > 0.0) {
        compiled.environment_texels = image.floats;
        compiled.environment_ends = selection_table(rows).end;
        compiled.environment_ends.insert(compiled.environment_ends.end(), columns.begin(),
                                         columns.end());
        compiled.lighting.environment_width = static_cast<uint32_t>(width);
        compiled.lighting.environment_height = static_cast<uint32_t>(height);
    }
    return integral;
}

}  // namespace rtrays
