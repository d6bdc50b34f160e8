// SPDX-License-Identifier: MIT
#include "renderer/base/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace rtrays {

namespace {

/// Returns the least number of letters to insert, delete or replace (Levenshtein 1966).
size_t distance(const std::string &a, const std::string &b) {
    std::vector<size_t> row(b.size() + 1);  // distances of a's beginning to the beginnings of b
    std::iota(row.begin(), row.end(), 0);
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string suggestion(const std::string &unknown, const std::vector<std::string> &known) {
    const std::string *nearest = nullptr;
    size_t least = unknown.size() / 3 + 1;
    for (const std::string &name : known) {
        if (const size_t changes = distance(unknown, name); changes < least) {
            least = changes;
            nearest = &name;
        }
    }
    return nearest != nullptr ? fmt::format("did you mean '{}'? ", *nearest) : "";
}

}  // namespace rtrays
