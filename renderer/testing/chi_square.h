// SPDX-License-Identifier: MIT
// Pearson's chi-square test of samples against their density.
#pragma once

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

namespace rtrays {

/// Returns the p-value of Pearson's test of counts against expected counts. Cells with an
/// expectation below five are pooled. A pool with an expectation below five is added to the
/// smallest other cell, so that every sample counts. Returns 0 if a cell with expectation 0 has a
/// sample. Throws std::logic_error if fewer than two cells remain.
inline double chi_square_p(const std::vector<uint64_t> &observed,
                           const std::vector<double> &expected) {
    struct Cell {
        double observed = 0, expected = 0;
    };
    Cell pool;
    std::vector<Cell> cells;
    for (size_t i = 0; i < observed.size(); ++i) {
        const auto o = static_cast<double>(observed[i]);
        if (expected[i] <= 0) {
            if (o > 0) {
                return 0;
            }
        } else if (expected[i] < 5) {
            pool.observed += o;
            pool.expected += expected[i];
        } else {
            cells.push_back({o, expected[i]});
        }
    }
    if (pool.expected >= 5) {
        cells.push_back(pool);
    } else if (!cells.empty()) {
        const auto smallest =
            std::min_element(cells.begin(), cells.end(),
                             [](const Cell &a, const Cell &b) { return a.expected < b.expected; });
        smallest->observed += pool.observed;
        smallest->expected += pool.expected;
    }
    if (cells.size() < 2) {
        throw std::logic_error("chi-square test: expected at least two cells of five samples");
    }
    double statistic = 0;
    for (const Cell &cell : cells) {
        statistic +=
            (cell.observed - cell.expected) * (cell.observed - cell.expected) / cell.expected;
    }
    const boost::math::chi_squared distribution(static_cast<double>(cells.size()) - 1);
    return boost::math::cdf(boost::math::complement(distribution, statistic));
}

/// Returns the integral over the rectangle [x0, x1] x [y0, y1], using the midpoint rule on a fine
/// grid.
inline double integrate(const std::function<double(double, double)> &f, double x0, double x1,
                        double y0, double y1) {
    constexpr int steps = 32;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            sum += f(x0 + (x1 - x0) * (i + 0.5) / steps, y0 + (y1 - y0) * (j + 0.5) / steps);
        }
    }
    return sum * (x1 - x0) * (y1 - y0) / (steps * steps);
}

}  // namespace rtrays
