// SPDX-License-Identifier: MIT
// Tests the MIS weights of truncated bidirectional path tracing. The stages accumulate the three
// weights of a path vertex by vertex. They must agree with weights from the densities of the full
// path in double precision, and sum to 1.
#include "renderer/kernels/mis/truncated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "renderer/testing/float_traps.h"

namespace rtrays {
namespace {

using Random = std::mt19937_64;

/// Densities along a path x_0 ... x_k, with the symbols of truncated.h. For deltas, `f` and `b` are
/// discrete probabilities times the ratio of the two solid angles.
struct Path {
    size_t k = 0;
    std::vector<double> f, b;  ///< per projected solid angle, away from and to the camera
    std::vector<bool> delta;
    double p_1 = 0;        ///< per area
    double n_l = 0;        ///< number of light paths
    double p_o = 0;        ///< of emission, per area
    double p_oe = 0;       ///< of light sampling, per area; 0 without the explicit strategy
    double p_d = 0;        ///< per projected solid angle
    double g = 0;          ///< G_{k-1}, of the last edge
    bool hittable = true;  ///< whether paths can hit the light
};

Path random_path(Random &random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto spread = [&](double decades) {
        return std::pow(10.0, decades * (2 * uniform(random) - 1));
    };
    Path path;
    path.k = 2 + static_cast<size_t>(random() % 12);
    path.f.resize(path.k);
    path.b.resize(path.k);
    path.delta.resize(path.k);
    for (size_t i = 1; i < path.k; ++i) {
        path.delta[i] = random() % 4 == 0;
        path.f[i] = path.delta[i] ? uniform(random) : spread(random() % 3 == 0 ? 6 : 1);
        path.b[i] = path.delta[i] ? path.f[i] * spread(0.4) : spread(random() % 3 == 0 ? 6 : 1);
    }
    path.p_1 = spread(4);
    path.n_l = std::floor(std::pow(10.0, 9 * uniform(random)));
    path.p_o = spread(3);
    path.p_oe = random() % 2 == 0 ? path.p_o : path.p_o * spread(2);
    path.p_oe *= random() % 8 == 0 ? 0.0 : 1.0;
    path.p_d = spread(1);
    path.g = spread(3);
    path.hittable = random() % 4 != 0;
    return path;
}

struct Weights {
    /// NaN if the strategy cannot sample the path.
    double implicit = 0, explicit_ = 0, light = 0;
};

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Returns the weights from the densities of the full path, using logarithms in double precision.
Weights expected(const Path &p, double beta) {
    const bool has_implicit = p.hittable, has_explicit = !p.delta[p.k - 1] && p.p_oe > 0,
               has_light = !p.delta[1];
    double camera = std::log2(p.p_1);  // x_1 ... x_{k-1}
    for (size_t i = 1; i + 1 < p.k; ++i) {
        camera += std::log2(p.f[i]);
    }
    const double log_implicit = camera + std::log2(p.f[p.k - 1]) + std::log2(p.g);
    const double log_explicit = camera + std::log2(p.p_oe);
    double log_light = std::log2(p.n_l) + std::log2(p.p_o) + std::log2(p.p_d) + std::log2(p.g);
    for (size_t i = p.k - 1; i >= 2; --i) {
        log_light += std::log2(p.b[i]);
    }
    const double minus = -std::numeric_limits<double>::infinity();
    const double i = has_implicit ? beta * log_implicit : minus,
                 e = has_explicit ? beta * log_explicit : minus,
                 l = has_light ? beta * log_light : minus;
    const double largest = std::max({i, e, l});
    const test::InvalidAllowed no_strategy_at_all;  // inf - inf
    const double sum = std::exp2(i - largest) + std::exp2(e - largest) + std::exp2(l - largest);
    return {has_implicit ? std::exp2(i - largest) / sum : none,
            has_explicit ? std::exp2(e - largest) / sum : none,
            has_light ? std::exp2(l - largest) / sum : none};
}

float log2_of(double x) {
    return static_cast<float>(std::log2(x));
}

/// Returns the weights as the stages compute them. G_i is omitted if both factors contain it.
/// G_{k-1} is the product of distance and cosines.
Weights shipped(const Path &p, float beta) {
    Weights weights{none, none, none};
    // Camera path.
    float log_r = log2_of(p.n_l) - log2_of(p.p_1);
    for (size_t i = 1; i < p.k; ++i) {
        const uint depth = static_cast<uint>(i - 1);
        if (i == p.k - 1 && !p.delta[i] && p.p_oe > 0) {
            const float implicit_over_explicit =
                p.hittable ? static_cast<float>(p.f[i] * p.g / p.p_oe) : 0.0f;
            const float log_light_over_explicit = log_r + log2_of(p.p_d * p.g) +
                                                  log2_of(p.p_o / p.p_oe) +
                                                  (depth > 0 ? log2_of(p.b[i]) : 0.0f);
            weights.explicit_ = static_cast<double>(
                camera_path_weight(implicit_over_explicit, log_light_over_explicit, beta));
        }
        log_r = continue_camera_ratio(log_r, depth, p.delta[i], p.delta[i] ? 0.0f : log2_of(p.f[i]),
                                      log2_of(p.b[i]) - log2_of(p.f[i]));
    }
    if (p.hittable) {
        const double explicit_over_implicit =
            p.delta[p.k - 1] ? 0.0 : p.p_oe / (p.f[p.k - 1] * p.g);
        weights.implicit = static_cast<double>(camera_path_weight(
            static_cast<float>(explicit_over_implicit), log_r + log2_of(p.p_o * p.p_d), beta));
    }
    // Light path.
    float log_q = p.hittable ? -log2_of(p.p_o) - log2_of(p.p_d) : -INFINITY;
    const float log_a = log2_of(p.p_oe / p.p_o) - log2_of(p.p_d * p.g);
    for (size_t i = p.k - 1; i >= 2; --i) {
        log_q = continue_light_ratio(log_q, log_a, static_cast<uint>(p.k - 1 - i), p.delta[i],
                                     p.delta[i] ? 0.0f : log2_of(p.b[i]),
                                     log2_of(p.f[i]) - log2_of(p.b[i]), beta);
    }
    if (!p.delta[1] && p.n_l > 0) {
        weights.light = static_cast<double>(
            light_path_weight(log_q, log_a, static_cast<uint>(p.k - 2), log2_of(p.f[1]),
                              log2_of(p.p_1) - log2_of(p.n_l), beta));
    }
    return weights;
}

TEST(TruncatedWeights, AgreeWithFullDensitiesAndSumToOne) {
    Random random(2013);
    for (const float beta : {1.0f, 2.0f, 1.5f}) {
        int all_three = 0;
        for (int trial = 0; trial < 100'000; ++trial) {
            const Path path = random_path(random);
            const Weights a = shipped(path, beta), b = expected(path, static_cast<double>(beta));
            double sum = 0;
            int strategies = 0;
            for (const auto weight : {&Weights::implicit, &Weights::explicit_, &Weights::light}) {
                ASSERT_EQ(std::isnan(a.*weight), std::isnan(b.*weight));
                if (!std::isnan(a.*weight)) {
                    // Logarithms of up to 2^8, rounded a dozen times.
                    ASSERT_NEAR(a.*weight, b.*weight, 2e-4) << "k " << path.k << ", beta " << beta;
                    sum += a.*weight;
                    ++strategies;
                }
            }
            all_three += strategies == 3 ? 1 : 0;
            if (strategies > 0) {
                ASSERT_NEAR(sum, 1, 3e-4);
            }
        }
        EXPECT_GT(all_three, 30'000);
    }
}

TEST(TruncatedWeights, EqualThoseOfPathTracingWithoutLightPaths) {
    Random random(2014);
    for (int trial = 0; trial < 10'000; ++trial) {
        Path path = random_path(random);
        path.n_l = 0;
        const Weights a = shipped(path, 2.0f), b = expected(path, 2.0);
        for (const auto weight : {&Weights::implicit, &Weights::explicit_}) {
            ASSERT_EQ(std::isnan(a.*weight), std::isnan(b.*weight));
            if (!std::isnan(a.*weight)) {
                ASSERT_NEAR(a.*weight, b.*weight, 2e-4);
            }
        }
    }
}

TEST(TruncatedWeights, NeverOverflow) {
    // On a near-specular path, the products themselves would exceed the range of float after a
    // dozen vertices.
    for (const double sharp : {1e8, 1e-8}) {
        Path path;
        path.k = 1000;
        path.f.assign(path.k, sharp);
        path.b.assign(path.k, 1 / sharp);
        path.delta.assign(path.k, false);
        path.p_1 = path.n_l = path.p_o = path.p_oe = path.p_d = path.g = 1;
        const Weights weights = shipped(path, 2.0f);
        const double sum = weights.implicit + weights.explicit_ + weights.light;
        EXPECT_NEAR(sum, 1, 1e-3);
        EXPECT_NEAR(weights.light, sharp > 1 ? 0 : 1, 1e-6);
    }
}

}  // namespace
}  // namespace rtrays
