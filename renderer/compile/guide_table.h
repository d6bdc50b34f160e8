// SPDX-License-Identifier: MIT
// Tables of directions of guides, in the layout of shared/guide_layout.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/shared/guide_layout.h"

namespace rtrays {

/// Appends the ends of a selection in proportion to `weights` (`selection_table`).
void append_selection(const std::vector<double> &weights, std::vector<uint32_t> &words);

/// Appends the table of GUIDE_BINS bins, by row and column, with the given weights, which are
/// positive. Returns the index of its first word.
uint32_t append_guide_table(const std::vector<double> &bins, std::vector<uint32_t> &words);

/// Returns the hash of a guide's words.
std::string guide_hash(const std::vector<uint32_t> &words);

/// Calls visit(bin, weight) for a bin and its neighbours, with the weights 1, 1/2 (edges) and 1/4
/// (corners). The last column is a neighbour of the first.
template <typename Visit>
void for_each_bin_around(size_t bin, const Visit &visit) {
    const auto row = static_cast<int>(bin / GUIDE_COLUMNS),
               column = static_cast<int>(bin % GUIDE_COLUMNS);
    constexpr auto rows = static_cast<int>(GUIDE_ROWS), columns = static_cast<int>(GUIDE_COLUMNS);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows - 1); ++y) {
        for (int x = column - 1; x <= column + 1; ++x) {
            visit(static_cast<size_t>(y * columns + (x + columns) % columns),
                  (y == row ? 1.0 : 0.5) * (x == column ? 1.0 : 0.5));
        }
    }
}

}  // namespace rtrays
