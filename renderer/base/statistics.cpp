// SPDX-License-Identifier: MIT
#include "renderer/base/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace rtrays {

double normal_p_value(double z) {
    // erfc keeps its relative precision far out in the tail, where 1 - cdf rounds to zero.
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

std::vector<double> holm_adjusted(std::vector<double> p_values) {
    for (double &p : p_values) {
        p = std::isnan(p) ? 0.0 : p;
    }
    std::vector<size_t> order(p_values.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return p_values[a] < p_values[b]; });
    std::vector<double> adjusted(p_values.size());
    double largest = 0;
    for (size_t rank = 0; rank < order.size(); ++rank) {
        const double scaled = static_cast<double>(order.size() - rank) * p_values[order[rank]];
        largest = std::max(largest, std::min(1.0, scaled));
        adjusted[order[rank]] = largest;
    }
    return adjusted;
}

}  // namespace rtrays
