// SPDX-License-Identifier: MIT
// Tests the MIS weights of truncated bidirectional path tracing. The passes accumulate the three
// weights of a path vertex by vertex. They must agree with weights from the densities of the full
// path in double precision, and sum to 1.
#include "renderer/kernels/light/mis.h"

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

/// Densities along a path x_0 ... x_k per projected solid angle. `forward[i]` is from x_i to
/// x_{i+1}, away from the camera; `back[i]` is from x_i to x_{i-1}. For deltas, they are discrete
/// probabilities times the ratio of the two solid angles.
struct Path {
    size_t k = 0;
    std::vector<double> forward, back;
    std::vector<bool> delta;
    double first = 0;            ///< P_1
    double light_paths = 0;      ///< n_L
    double origin = 0;           ///< p_o of emission
    double explicit_origin = 0;  ///< p_o of light sampling
    double direction = 0;        ///< p_d
    double geometry = 0;         ///< G of the last edge
    bool hittable = true;        ///< whether paths can hit the light
};

Path random_path(Random &random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto spread = [&](double decades) {
        return std::pow(10.0, decades * (2 * uniform(random) - 1));
    };
    Path path;
    path.k = 2 + static_cast<size_t>(random() % 12);
    path.forward.resize(path.k);
    path.back.resize(path.k);
    path.delta.resize(path.k);
    for (size_t i = 1; i < path.k; ++i) {
        path.delta[i] = random() % 4 == 0;
        path.forward[i] = path.delta[i] ? uniform(random) : spread(random() % 3 == 0 ? 6 : 1);
        path.back[i] =
            path.delta[i] ? path.forward[i] * spread(0.4) : spread(random() % 3 == 0 ? 6 : 1);
    }
    path.first = spread(4);
    path.light_paths = std::floor(std::pow(10.0, 9 * uniform(random)));
    path.origin = spread(3);
    path.explicit_origin = random() % 2 == 0 ? path.origin : path.origin * spread(2);
    path.direction = spread(1);
    path.geometry = spread(3);
    path.hittable = random() % 4 != 0;
    return path;
}

struct Weights {
    /// NaN if the technique cannot sample the path.
    double implicit = 0, explicit_ = 0, light = 0;
};

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Returns the weights from the densities of the full path, using logarithms in double precision.
Weights expected(const Path &p, double beta) {
    const bool has_implicit = p.hittable, has_explicit = !p.delta[p.k - 1], has_light = !p.delta[1];
    double camera = std::log2(p.first);  // x_1 ... x_{k-1}
    for (size_t i = 1; i + 1 < p.k; ++i) {
        camera += std::log2(p.forward[i]);
    }
    const double log_implicit = camera + std::log2(p.forward[p.k - 1]) + std::log2(p.geometry);
    const double log_explicit = camera + std::log2(p.explicit_origin);
    double log_light = std::log2(p.light_paths) + std::log2(p.origin) + std::log2(p.direction) +
                       std::log2(p.geometry);
    for (size_t i = p.k - 1; i >= 2; --i) {
        log_light += std::log2(p.back[i]);
    }
    const double minus = -std::numeric_limits<double>::infinity();
    const double i = has_implicit ? beta * log_implicit : minus,
                 e = has_explicit ? beta * log_explicit : minus,
                 l = has_light ? beta * log_light : minus;
    const double largest = std::max({i, e, l});
    const test::InvalidAllowed no_technique_at_all;  // inf - inf
    const double sum = std::exp2(i - largest) + std::exp2(e - largest) + std::exp2(l - largest);
    return {has_implicit ? std::exp2(i - largest) / sum : none,
            has_explicit ? std::exp2(e - largest) / sum : none,
            has_light ? std::exp2(l - largest) / sum : none};
}

float log2_of(double x) {
    return static_cast<float>(std::log2(x));
}

/// Returns the weights as the stages compute them. G is omitted if both factors contain it. In
/// `arrival` and in the density per solid angle, G represents the product of distance and cosines.
Weights shipped(const Path &p, float beta) {
    Weights weights{none, none, none};
    // Camera path.
    float ratio = log2_of(p.light_paths) - log2_of(p.first);
    for (size_t i = 1; i < p.k; ++i) {
        const uint depth = static_cast<uint>(i - 1);
        if (i == p.k - 1) {
            if (!p.delta[i]) {
                const float implicit =
                    p.hittable ? static_cast<float>(p.forward[i] * p.geometry / p.explicit_origin)
                               : 0.0f;
                float light = ratio + log2_of(p.direction * p.geometry) +
                              log2_of(p.origin / p.explicit_origin);
                light += depth > 0 ? log2_of(p.back[i]) : 0.0f;
                weights.explicit_ = static_cast<double>(camera_path_weight(implicit, light, beta));
            }
        }
        const float log_forward = p.delta[i] ? 0.0f : log2_of(p.forward[i]);
        ratio = continue_camera_ratio(ratio, depth, p.delta[i], log_forward,
                                      log2_of(p.back[i]) - log2_of(p.forward[i]));
    }
    if (p.hittable) {
        const double by_explicit =
            p.delta[p.k - 1] ? 0.0 : p.explicit_origin / (p.forward[p.k - 1] * p.geometry);
        weights.implicit = static_cast<double>(camera_path_weight(
            static_cast<float>(by_explicit), ratio + log2_of(p.origin * p.direction), beta));
    }
    // Light path.
    float log_ratio = p.hittable ? -log2_of(p.origin) - log2_of(p.direction) : -INFINITY;
    const float log_explicit =
        log2_of(p.explicit_origin / p.origin) - log2_of(p.direction * p.geometry);
    for (size_t i = p.k - 1; i >= 2; --i) {
        const float log_forward = p.delta[i] ? 0.0f : log2_of(p.back[i]);
        log_ratio = continue_light_ratio(log_ratio, log_explicit, static_cast<uint>(p.k - 1 - i),
                                         p.delta[i], log_forward,
                                         log2_of(p.forward[i]) - log2_of(p.back[i]), beta);
    }
    if (!p.delta[1] && p.light_paths > 0) {
        weights.light = static_cast<double>(light_path_weight(
            log_ratio, log_explicit, static_cast<uint>(p.k - 2), log2_of(p.forward[1]),
            log2_of(p.first) - log2_of(p.light_paths), beta));
    }
    return weights;
}

TEST(TruncatedWeights, OfAPathAgreeAndSumToOne) {
    Random random(2013);
    for (const float beta : {1.0f, 2.0f, 1.5f}) {
        int all_three = 0;
        for (int trial = 0; trial < 100'000; ++trial) {
            const Path path = random_path(random);
            const Weights a = shipped(path, beta), b = expected(path, static_cast<double>(beta));
            double sum = 0;
            int techniques = 0;
            for (const auto weight : {&Weights::implicit, &Weights::explicit_, &Weights::light}) {
                ASSERT_EQ(std::isnan(a.*weight), std::isnan(b.*weight));
                if (!std::isnan(a.*weight)) {
                    // Logarithms of up to 2^8, rounded a dozen times.
                    ASSERT_NEAR(a.*weight, b.*weight, 2e-4) << "k " << path.k << ", beta " << beta;
                    sum += a.*weight;
                    ++techniques;
                }
            }
            all_three += techniques == 3 ? 1 : 0;
            if (techniques > 0) {
                ASSERT_NEAR(sum, 1, 3e-4);
            }
        }
        EXPECT_GT(all_three, 30'000);
    }
}

TEST(TruncatedWeights, WithoutLightPathsAreThoseOfPathTracing) {
    Random random(2014);
    for (int trial = 0; trial < 10'000; ++trial) {
        Path path = random_path(random);
        path.light_paths = 0;
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
        path.forward.assign(path.k, sharp);
        path.back.assign(path.k, 1 / sharp);
        path.delta.assign(path.k, false);
        path.first = path.light_paths = path.origin = path.explicit_origin = path.direction =
            path.geometry = 1;
        const Weights weights = shipped(path, 2.0f);
        const double sum = weights.implicit + weights.explicit_ + weights.light;
        EXPECT_NEAR(sum, 1, 1e-3);
        EXPECT_NEAR(weights.light, sharp > 1 ? 0 : 1, 1e-6);
    }
}

// Checks the stated error bounds for quotients of all magnitudes and near 1.
TEST(Logarithm, OfQuotientsIsThatOfDouble) {
    Random random(3);
    std::uniform_real_distribution<double> exponent(-120, 120), near(-1e-3, 1e-3);
    double worst = 0, worst_near = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const auto a = static_cast<float>(std::exp2(exponent(random))),
                   b = static_cast<float>(std::exp2(exponent(random)));
        const double expected = std::log2(static_cast<double>(a) / static_cast<double>(b));
        const double half_ulp = 0x1p-24 * std::abs(expected);
        worst = std::max(worst,
                         std::abs(static_cast<double>(log2_quotient(a, b)) - expected) - half_ulp);
        const auto c = static_cast<float>(static_cast<double>(a) * (1 + near(random)));
        const double small = std::log2(static_cast<double>(c) / static_cast<double>(a));
        worst_near =
            std::max(worst_near, std::abs(static_cast<double>(log2_quotient(c, a)) - small) /
                                     std::max(std::abs(small), 1e-30));
    }
    EXPECT_LT(worst, 1.5e-7);
    EXPECT_LT(worst_near, 4e-7);
}

TEST(Logarithm, OfNothingIsMinusInfinity) {
    const float smallest = std::numeric_limits<float>::min(),
                largest = std::numeric_limits<float>::max();
    EXPECT_EQ(log2_quotient(0.0f, 1.0f), -INFINITY);
    EXPECT_EQ(log2_quotient(0.5f * smallest, 3.0f), -INFINITY);
    EXPECT_EQ(log2_of(smallest), -126.0f);
    EXPECT_EQ(log2_of(1.0f), 0.0f);
    EXPECT_FLOAT_EQ(log2_quotient(largest, smallest), 254.0f);
    for (const float nothing : {0.0f, std::numeric_limits<float>::denorm_min()}) {
        EXPECT_TRUE(std::isfinite(log2_quotient(largest, nothing)));
        EXPECT_TRUE(std::isfinite(log2_quotient(smallest, nothing)));
    }
}

TEST(PowerOfTwo, IsThatOfDouble) {
    Random random(4);
    std::uniform_real_distribution<float> exponent(-126, 127);
    double worst = 0;
    for (int i = 0; i < 1'000'000; ++i) {
        const float x = exponent(random);
        worst = std::max(
            worst,
            std::abs(static_cast<double>(power_of_two(x)) / std::exp2(static_cast<double>(x)) - 1));
    }
    EXPECT_LT(worst, 1e-7);
    EXPECT_EQ(power_of_two(0.0f), 1.0f);
    EXPECT_EQ(power_of_two(-INFINITY), 0.0f);
    EXPECT_EQ(power_of_two(-500.0f), 0.0f);
    EXPECT_EQ(power_of_two(500.0f), INFINITY);
    EXPECT_EQ(power_of_two(INFINITY), INFINITY);
}

}  // namespace
}  // namespace rtrays
