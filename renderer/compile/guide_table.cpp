// SPDX-License-Identifier: MIT
#include "renderer/compile/guide_table.h"

#include <numeric>

#include "renderer/base/files.h"
#include "renderer/compile/compile_scene.h"

namespace rtrays {

void append_selection(const std::vector<double> &weights, std::vector<uint32_t> &words) {
    const SelectionTable table = selection_table(weights);
    words.insert(words.end(), table.end.begin(), table.end.end());
}

uint32_t append_guide_table(const std::vector<double> &bins, std::vector<uint32_t> &words) {
    const auto first = static_cast<uint32_t>(words.size());
    std::vector<double> rows;
    for (auto row = bins.begin(); row != bins.end(); row += GUIDE_COLUMNS) {
        rows.push_back(std::accumulate(row, row + GUIDE_COLUMNS, 0.0));
    }
    append_selection(rows, words);
    for (auto row = bins.begin(); row != bins.end(); row += GUIDE_COLUMNS) {
        append_selection({row, row + GUIDE_COLUMNS}, words);
    }
    return first;
}

std::string guide_hash(const std::vector<uint32_t> &words) {
    return content_hash(
        std::string(reinterpret_cast<const char *>(words.data()), words.size() * sizeof(uint32_t)));
}

}  // namespace rtrays
