// SPDX-License-Identifier: MIT
// Chi-square tests of the starts of light paths.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "renderer/base/angles.h"
#include "renderer/testing/chi_square.h"

namespace rtrays {

/// Returns the index of the one of `n` equal parts of [0, 1] that contains x.
inline size_t part(double x, int n) {
    return static_cast<size_t>(std::clamp(static_cast<int>(x * n), 0, n - 1));
}

/// Returns the azimuth about an axis as a fraction of a full turn, in [0, 1]. It is measured from
/// an arbitrary direction.
inline double turn(const Eigen::Vector3d &axis, const Eigen::Vector3d &v) {
    const Eigen::Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
    return std::atan2(v.dot(y), v.dot(x)) / (2 * pi) + 0.5;
}

/// Sample counts of cells, each with its probability in closed form. Computes p-values without and
/// with a planted error, which adds 2 % to the cells with even indices. At most eleven chi-square
/// tests of a program share a family-wise level of 0.01, so each has the level 0.01 / 11
/// (Bonferroni).
struct Cells {
    static constexpr double level = 0.01 / 11;
    std::vector<uint64_t> observed;
    std::vector<double> probability;
    uint32_t samples = 0;

    explicit Cells(std::vector<double> expected)
        : observed(expected.size()), probability(std::move(expected)) {}
    explicit Cells(size_t equal)
        : Cells(std::vector<double>(equal, 1.0 / static_cast<double>(equal))) {}

    void add(size_t cell) {
        ++observed.at(cell);
        ++samples;
    }
    void expect_fit(const std::string &what) const {
        EXPECT_GT(p(0.0), level) << what;
        EXPECT_LT(p(0.02), level) << what;
        EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0), 1.0, 1e-6)
            << what;
    }
    double p(double planted) const {
        std::vector<double> expected;
        for (size_t i = 0; i < probability.size(); ++i) {
            expected.push_back(samples * probability[i] * (i % 2 == 0 ? 1.0 + planted : 1.0));
        }
        return chi_square_p(observed, expected);
    }
};

}  // namespace rtrays
