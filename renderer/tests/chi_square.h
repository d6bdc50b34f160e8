// SPDX-License-Identifier: MIT
// Chi-square goodness-of-fit of a sampler against its density.
#pragma once

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

namespace rtrays {

/// p-value of Pearson's test of counts against expected counts. Cells expecting fewer than five are pooled; a
/// sample in a cell that expects none rejects outright (p = 0).
inline double chi_square_p(const std::vector<uint64_t> &observed, const std::vector<double> &expected) {
    double statistic = 0, pooled_observed = 0, pooled_expected = 0;
    int cells = 0;
    const auto add = [&](double o, double e) {
        statistic += (o - e) * (o - e) / e;
        ++cells;
    };
    for (size_t i = 0; i < observed.size(); ++i) {
        const auto o = static_cast<double>(observed[i]);
        if (expected[i] <= 0) {
            if (o > 0) {
                return 0;
            }
        } else if (expected[i] < 5) {
            pooled_observed += o;
            pooled_expected += expected[i];
        } else {
            add(o, expected[i]);
        }
    }
    if (pooled_expected >= 5) {
        add(pooled_observed, pooled_expected);
    }
    if (cells < 2) {
        throw std::logic_error("chi-square needs two cells that expect five samples");
    }
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(cells - 1), statistic));
}

/// Integral over the rectangle [x0, x1] x [y0, y1] by the midpoint rule on a fine grid.
inline double integrate(const std::function<double(double, double)> &f, double x0, double x1, double y0, double y1) {
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
