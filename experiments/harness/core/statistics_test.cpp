// SPDX-License-Identifier: MIT
// Tests the statistics against known answers, and their error rates by simulation.
#include "experiments/harness/core/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "renderer/base/error.h"
#include "renderer/base/statistics.h"

namespace rtrays {
namespace {

TEST(Quantile, InterpolatesOrderStatistics) {
    EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0), 1);
    EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 1), 4);
    EXPECT_DOUBLE_EQ(quantile({10, 20}, 0.25), 12.5);
    EXPECT_THROW(quantile({}, 0.5), Error);
}

TEST(MedianInterval, UsesTheTabulatedRanks) {
    // The ranks of the 95 % interval are 2 and 8 for n = 9, and 1 and 8 for n = 8.
    const auto nine = median_interval({1, 2, 3, 4, 5, 6, 7, 8, 9});
    EXPECT_DOUBLE_EQ(nine.value, 5);
    EXPECT_DOUBLE_EQ(nine.low, 2);
    EXPECT_DOUBLE_EQ(nine.high, 8);
    const auto eight = median_interval({1, 2, 3, 4, 5, 6, 7, 8});
    EXPECT_DOUBLE_EQ(eight.low, 1);
    EXPECT_DOUBLE_EQ(eight.high, 8);
    EXPECT_THROW(median_interval({1, 2, 3, 4, 5}), Error);
}

TEST(MeanInterval, IsStudents) {
    // The standard error is 1 / sqrt(3), and t with 2 degrees of freedom is 9.924843.
    const auto interval = mean_interval({1, 2, 3}, 0.99);
    EXPECT_DOUBLE_EQ(interval.value, 2);
    EXPECT_NEAR(interval.low, 2 - 9.924843 / std::sqrt(3.0), 1e-5);
    EXPECT_NEAR(interval.high, 2 + 9.924843 / std::sqrt(3.0), 1e-5);
    EXPECT_THROW(mean_interval({1}, 0.99), Error);
}

TEST(WeightedSlope, ExactLineAndWeights) {
    EXPECT_DOUBLE_EQ(weighted_slope({0, 1, 2}, {1, 3, 5}, {1, 5, 2}), 2);
    // Weight 0 excludes a point.
    EXPECT_DOUBLE_EQ(weighted_slope({0, 1, 2}, {0, 1, 7}, {1, 1, 0}), 1);
    EXPECT_THROW(weighted_slope({1, 1}, {0, 1}, {1, 1}), Error);
}

TEST(Holm, KnownAnswer) {
    const auto adjusted = holm_adjusted({0.01, 0.04, 0.03, 0.005});
    EXPECT_DOUBLE_EQ(adjusted[3], 0.02);
    EXPECT_DOUBLE_EQ(adjusted[0], 0.03);
    EXPECT_DOUBLE_EQ(adjusted[2], 0.06);
    EXPECT_DOUBLE_EQ(adjusted[1], 0.06);
    EXPECT_DOUBLE_EQ(holm_adjusted({0.9, 0.8})[0], 1.0);
    // A NaN is rejected at any position.
    const auto broken = holm_adjusted({0.5, std::nan(""), 0.9});
    EXPECT_EQ(broken[1], 0.0);
    EXPECT_DOUBLE_EQ(broken[0], 1.0);
}

TEST(Normal, TailsKeepTheirPrecision) {
    EXPECT_NEAR(normal_p_value(1.959963984540054), 0.05, 1e-12);
    EXPECT_NEAR(normal_p_value(-20) / 5.507248237212467e-89, 1, 1e-9);
    EXPECT_NEAR(normal_quantile_two_sided(0.99), 2.5758293035489004, 1e-12);
}

/// Returns one seed's RMSE along a ladder of cumulative samples. The values are means of growing
/// numbers of Gaussian samples in `pixels` pixels: points of a seed are correlated as in a render.
std::vector<double> ladder(const std::vector<double> &spp, int pixels, std::mt19937_64 &engine) {
    std::normal_distribution<double> noise;
    std::vector<double> sums(static_cast<size_t>(pixels), 0.0), errors;
    double done = 0;
    for (double n : spp) {
        double squares = 0;
        for (double &sum : sums) {
            sum += std::sqrt(n - done) * noise(engine);
            squares += (sum / n) * (sum / n);
        }
        done = n;
        errors.push_back(std::sqrt(squares / pixels));
    }
    return errors;
}

TEST(ConvergenceSlope, ExactPowerLaw) {
    const std::vector<double> spp{1, 2, 4, 8};
    const std::vector<double> errors{8, 4, 2, 1};
    const auto slope = convergence_slope(spp, std::vector<std::vector<double>>(8, errors));
    EXPECT_NEAR(slope.value, -1, 1e-12);
    EXPECT_NEAR(slope.high - slope.low, 0, 1e-12);
}

TEST(ConvergenceSlope, IntervalCoversMinusOneHalfAtItsRate) {
    const std::vector<double> spp{1, 2, 4, 8, 16, 32, 64, 128};
    std::mt19937_64 engine(1);
    int covered = 0;
    const int runs = 400;
    double width = 0;
    for (int run = 0; run < runs; ++run) {
        std::vector<std::vector<double>> errors;
        for (int seed = 0; seed < 8; ++seed) {
            errors.push_back(ladder(spp, 100, engine));
        }
        const auto slope = convergence_slope(spp, errors, 0.95, 1000);
        covered += slope.low <= -0.5 && -0.5 <= slope.high ? 1 : 0;
        width += (slope.high - slope.low) / runs;
    }
    // 95 % of 400 is 380, and the 99.9 % range of the binomial is 364 to 393. A percentile
    // bootstrap covers about 355.
    EXPECT_GE(covered, 364);
    EXPECT_LE(covered, 393);
    EXPECT_LT(width, 0.1);
}

TEST(ConvergenceSlope, TellsABiasedCurveFromMinusOneHalf) {
    const std::vector<double> spp{1, 2, 4, 8, 16, 32, 64, 128};
    std::mt19937_64 engine(2);
    std::vector<std::vector<double>> errors;
    for (int seed = 0; seed < 8; ++seed) {
        errors.push_back(ladder(spp, 1000, engine));
        for (double &error : errors.back()) {
            error = std::hypot(error, 0.05);  // a bias of 5 % of the one-sample noise
        }
    }
    EXPECT_GT(convergence_slope(spp, errors).low, -0.5);
}

TEST(ConvergenceSlope, NeedsEightSeedsAndPositiveErrors) {
    EXPECT_THROW(convergence_slope({1, 2}, std::vector<std::vector<double>>(7, {2, 1})), Error);
    EXPECT_THROW(convergence_slope({1, 2}, std::vector<std::vector<double>>(8, {2, 0})), Error);
}

TEST(ConvergenceSlope, ScatterMovesLogarithms) {
    // The squares are log-normal with mean 1, and sigma is 0.6 at the first point and 0.1 at the
    // last. The mean of their logarithm is -sigma^2 / 2.
    std::mt19937_64 engine(4);
    std::normal_distribution<double> noise;
    std::vector<std::vector<double>> errors;
    for (int seed = 0; seed < 20000; ++seed) {
        errors.emplace_back();
        for (const double sigma : {0.6, 0.1}) {
            errors.back().push_back(std::exp(0.5 * (sigma * noise(engine) - 0.5 * sigma * sigma)));
        }
    }
    // The mean of the squares does not fall.
    const double slope = convergence_slope({1, 16}, errors, 0.95, 100).value;
    EXPECT_NEAR(slope, (0.36 - 0.01) / 4 / std::log(16.0), 0.003);
    // First order in the relative variance, which is exp(sigma^2) - 1 for log-normal squares.
    EXPECT_NEAR(slope_bias_of_scatter({1, 16}, errors),
                (std::expm1(0.36) - std::expm1(0.01)) / 4 / std::log(16.0), 0.003);
}

TEST(PairedErrorRatio, KnownAnswer) {
    // The log ratios 0 and 0.2 have mean 0.1 and standard error 0.1; t(0.975, 1) = 12.706.
    const auto change = paired_error_ratio({1, std::exp(0.2)}, {1, 1}, 0.975);
    EXPECT_NEAR(change.value, std::expm1(0.1), 1e-12);
    EXPECT_NEAR(change.high, std::expm1(0.1 + 1.2706204736), 1e-6);
    EXPECT_NEAR(change.low, std::expm1(0.1 - 1.2706204736), 1e-6);
}

TEST(PairedErrorRatio, EqualErrorsPass) {
    const auto change = paired_error_ratio({1, 2, 3}, {1, 2, 3});
    EXPECT_EQ(change.value, 0);
    EXPECT_EQ(decide_gate(change), GateDecision::pass);
}

TEST(Gate, Rule) {
    EXPECT_EQ(decide_gate({0.06, 0.01, 0.2}), GateDecision::fail);
    EXPECT_EQ(decide_gate({0.06, -0.01, 0.2}), GateDecision::undecided);
    EXPECT_EQ(decide_gate({0.04, 0.01, 0.2}), GateDecision::undecided);
    EXPECT_EQ(decide_gate({0.04, 0.01, 0.049}), GateDecision::pass);
    EXPECT_EQ(decide_gate({-0.3, -0.4, -0.2}), GateDecision::pass);
}

/// Counts the decisions of one stage with 16 independent pairs if the error truly changes by
/// `change` and the log error of one render scatters by `sigma`.
std::array<int, 3> simulate_gate(double change, double sigma, int runs) {
    std::mt19937_64 engine(3);
    std::normal_distribution<double> noise(0, sigma);
    std::array<int, 3> counts{};
    for (int run = 0; run < runs; ++run) {
        std::vector<double> candidate(16), baseline(16);
        for (size_t k = 0; k < 16; ++k) {
            baseline[k] = std::exp(noise(engine));
            candidate[k] = (1 + change) * std::exp(noise(engine));
        }
        ++counts[static_cast<size_t>(decide_gate(paired_error_ratio(candidate, baseline)))];
    }
    return counts;
}

TEST(Gate, FalsePositiveRateAndPower) {
    // The log RMSE of a render with 64 x 64 pixels scatters by about 2 % between seeds.
    const auto unchanged = simulate_gate(0, 0.02, 20000);
    EXPECT_EQ(unchanged[1], 0);      // never a false alarm
    EXPECT_GE(unchanged[0], 19900);  // a second stage is rare
    const auto worse = simulate_gate(0.10, 0.02, 2000);
    EXPECT_GE(worse[1], 1990);  // +10 % is found in the first stage
    // At the boundary, a false "pass" has the probability 0.1 % of the 99.9 % bound.
    const auto boundary = simulate_gate(0.05, 0.02, 20000);
    EXPECT_LE(boundary[0], 36);  // 0.1 % of 20000 is 20; 36 is its 99.9 % quantile
}

TEST(Statistics, ExponentOfAPowerLaw) {
    std::vector<double> x, exact;
    for (int i = 0; i < 8; ++i) {
        x.push_back(std::pow(3.0, i));
        exact.push_back(5 * std::pow(x.back(), 1.25));
    }
    const Interval interval = power_law_exponent(x, exact);
    EXPECT_NEAR(interval.value, 1.25, 1e-12);
    EXPECT_NEAR(interval.high - interval.low, 0, 1e-6);
    // Three points with residuals 1, -2, 1 around a slope of 1. The half width is t with one degree
    // of freedom times sqrt(6 / 2).
    const double e = std::exp(1.0);
    const Interval rough = power_law_exponent({1, e, e * e}, {e, 1 / e, e * e * e});
    EXPECT_NEAR(rough.value, 1, 1e-12);
    EXPECT_NEAR(rough.high - 1, 12.7062 * std::sqrt(3.0), 1e-3);
    EXPECT_NEAR(1 - rough.low, 12.7062 * std::sqrt(3.0), 1e-3);
    EXPECT_THROW(power_law_exponent({1, 2}, {1, 2}), Error);
    EXPECT_THROW(power_law_exponent({1, 2, 3}, {1, 0, 3}), Error);
}

TEST(Statistics, ExponentsCoverTheTruthAsOftenAsTheySay) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0, 0.2);
    int covered = 0;
    const int trials = 4000;
    for (int trial = 0; trial < trials; ++trial) {
        std::vector<double> x, y;
        for (int i = 0; i < 7; ++i) {
            x.push_back(std::pow(4.0, i));
            y.push_back(std::pow(x.back(), 1.1) * std::exp(noise(random)));
        }
        const Interval interval = power_law_exponent(x, y);
        covered += interval.low <= 1.1 && 1.1 <= interval.high ? 1 : 0;
    }
    EXPECT_NEAR(covered, 0.95 * trials, 4 * std::sqrt(0.95 * 0.05 * trials));
}

}  // namespace
}  // namespace rtrays
