// SPDX-License-Identifier: MIT
// Tests the MIS weights of full bidirectional path tracing. The stages accumulate the weights of
// all strategies of a path vertex by vertex. They must agree with weights from the densities of the
// full path in double precision, and sum to 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "renderer/kernels/mis/bidirectional.h"
#include "renderer/kernels/mis/truncated.h"

namespace rtrays {
namespace {

using Random = std::mt19937_64;

/// Densities along a path x_0 ... x_k, with the symbols of bidirectional.h. For deltas, `f` and `b`
/// are discrete probabilities times the ratio of the two solid angles.
struct Path {
    size_t k = 0;
    std::vector<double> f, b;  ///< per projected solid angle, away from and to the camera
    std::vector<double> g;     ///< `g[i]`: G_i, projected solid angle per area
    std::vector<bool> delta;
    double p_1 = 0;        ///< per area
    double n_l = 0;        ///< number of light paths
    double p_o = 0;        ///< of emission, per area
    double p_oe = 0;       ///< of light sampling, per area
    double p_d = 0;        ///< per projected solid angle
    bool hittable = true;  ///< whether paths can hit the light
};

/// Returns a path with random densities within `decades` of 1. One in three densities spreads three
/// times as far.
Path random_path(Random &random, double decades) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto spread = [&](double width) {
        return std::pow(10.0, width * (2 * uniform(random) - 1));
    };
    const auto density = [&] { return spread(random() % 3 == 0 ? 3 * decades : decades); };
    Path path;
    path.k = 2 + static_cast<size_t>(random() % 9);
    path.f.resize(path.k);
    path.b.resize(path.k);
    path.g.resize(path.k);
    path.delta.resize(path.k);
    for (size_t i = 1; i < path.k; ++i) {
        path.delta[i] = random() % 4 == 0;
        path.f[i] = path.delta[i] ? uniform(random) : density();
        path.b[i] = path.delta[i] ? path.f[i] * spread(0.4) : density();
        path.g[i] = density();
    }
    path.p_1 = density();
    path.n_l = std::floor(1 + spread(1) * 1e1);
    path.p_o = density();
    path.p_oe = random() % 2 == 0 ? path.p_o : density();
    path.p_d = density();
    path.hittable = random() % 4 != 0;
    return path;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Returns the weights from the densities of the full path, using logarithms in double precision.
/// Weight m belongs to the strategy whose camera path ends at x_m: 0 is the light path, 1 to k - 2
/// are connections, k - 1 is explicit, k is implicit. It is NaN if the strategy cannot sample the
/// path.
std::vector<double> expected(const Path &p, double beta) {
    std::vector<double> logs(p.k + 1, -std::numeric_limits<double>::infinity());
    for (size_t m = 0; m <= p.k; ++m) {
        const bool possible = m == 0         ? !p.delta[1]
                              : m == p.k     ? p.hittable
                              : m == p.k - 1 ? !p.delta[m]
                                             : !p.delta[m] && !p.delta[m + 1];
        if (!possible) {
            continue;
        }
        double log_density = m == 0 ? std::log2(p.n_l) : std::log2(p.p_1);
        for (size_t i = 1; i < m; ++i) {
            log_density += std::log2(p.f[i]) + std::log2(p.g[i]);
        }
        if (m == p.k - 1) {
            log_density += std::log2(p.p_oe);
        } else if (m < p.k - 1) {
            log_density += std::log2(p.p_o) + std::log2(p.p_d) + std::log2(p.g[p.k - 1]);
            for (size_t i = p.k - 1; i >= m + 2; --i) {
                log_density += std::log2(p.b[i]) + std::log2(p.g[i - 1]);
            }
        }
        logs[m] = beta * log_density;
    }
    const double largest = *std::max_element(logs.begin(), logs.end());
    std::vector<double> weights(p.k + 1, none);
    double sum = 0;
    for (const double log_density : logs) {
        sum += std::isinf(log_density) ? 0 : std::exp2(log_density - largest);
    }
    for (size_t m = 0; m <= p.k; ++m) {
        weights[m] = std::isinf(logs[m]) ? none : std::exp2(logs[m] - largest) / sum;
    }
    return weights;
}

float log2_of(double x) {
    return static_cast<float>(std::log2(x));
}

/// What a path stores at its arrival at a vertex: log2 of S at the vertex before, and of A.
struct Arrival {
    float log_s = 0, log_a = 0;
};

/// Returns log2 of A at the end of a ray that leaves a vertex with this density. The density
/// includes G, so distance and cosine are 1.
float log_inverse_arrival(bool delta, double pdf_a) {
    return log_inverse_pdf_a(delta ? INFINITY : static_cast<float>(pdf_a), 1.0f, 1.0f);
}

/// Returns what a camera path stores at x_i, for i = 1 ... k.
std::vector<Arrival> camera_arrivals(const Path &p, float beta) {
    std::vector<Arrival> at(p.k + 1);
    at[1] = {-INFINITY, log2_of(p.n_l / p.p_1)};
    for (size_t i = 1; i < p.k; ++i) {
        at[i + 1] = {continue_strategies(at[i].log_s, at[i].log_a, p.delta[i],
                                         p.delta[i] ? 0.0f : log2_of(p.f[i]),
                                         log2_of(p.b[i] / p.f[i]), beta),
                     log_inverse_arrival(p.delta[i], p.f[i] * p.g[i])};
    }
    return at;
}

/// Returns what a light path stores at x_i, for i = k - 1 ... 1.
std::vector<Arrival> light_arrivals(const Path &p, float beta) {
    std::vector<Arrival> at(p.k + 1);
    at[p.k - 1] = {p.hittable ? -log2_of(p.p_o * p.p_d) : -INFINITY,
                   log2_of(p.p_oe / p.p_o) - log2_of(p.p_d * p.g[p.k - 1])};
    for (size_t i = p.k - 1; i >= 2; --i) {
        at[i - 1] = {continue_strategies(at[i].log_s, at[i].log_a, p.delta[i],
                                         p.delta[i] ? 0.0f : log2_of(p.b[i]),
                                         log2_of(p.f[i] / p.b[i]), beta),
                     log_inverse_arrival(p.delta[i], p.b[i] * p.g[i - 1])};
    }
    return at;
}

/// Returns the weights as the stages compute them.
std::vector<double> shipped(const Path &p, float beta) {
    const std::vector<Arrival> camera = camera_arrivals(p, beta), light = light_arrivals(p, beta);
    const auto before = [&](const Arrival &at, double reverse) {
        return strategies_before(at.log_s, at.log_a, log2_of(reverse), beta);
    };
    std::vector<double> weights(p.k + 1, none);
    if (!p.delta[1]) {
        weights[0] = static_cast<double>(
            power_heuristic_of_log(log2_of(p.p_1 / p.n_l) + before(light[1], p.f[1]), beta));
    }
    for (size_t m = 1; m + 2 <= p.k; ++m) {
        if (!p.delta[m] && !p.delta[m + 1]) {
            weights[m] = static_cast<double>(connection_weight(
                log2_of(p.b[m + 1] * p.g[m]) + before(camera[m], p.b[m]),
                log2_of(p.f[m] * p.g[m]) + before(light[m + 1], p.f[m + 1]), beta));
        }
    }
    const size_t last = p.k - 1;
    const double implicit_over_explicit = p.f[last] * p.g[last] / p.p_oe;
    if (!p.delta[last]) {
        const float log_arrival = log2_of(p.p_d * p.g[last]) + log2_of(p.p_o / p.p_oe);
        weights[last] = static_cast<double>(
            camera_path_weight(p.hittable ? static_cast<float>(implicit_over_explicit) : 0.0f,
                               log_arrival + before(camera[last], p.b[last]), beta));
    }
    if (p.hittable) {
        weights[p.k] = static_cast<double>(camera_path_weight(
            p.delta[last] ? 0.0f : static_cast<float>(1 / implicit_over_explicit),
            camera[p.k].log_s + log2_of(p.p_o * p.p_d), beta));
    }
    return weights;
}

TEST(BidirectionalWeights, AgreeWithFullDensitiesAndSumToOne) {
    Random random(1997);
    for (const float beta : {1.0f, 2.0f, 1.5f}) {
        for (const double decades : {0.3, 2.0}) {
            int many = 0;
            for (int trial = 0; trial < 50'000; ++trial) {
                const Path path = random_path(random, decades);
                const std::vector<double> a = shipped(path, beta),
                                          b = expected(path, static_cast<double>(beta));
                double sum = 0;
                int shares = 0, strategies = 0;
                for (size_t m = 0; m <= path.k; ++m) {
                    ASSERT_EQ(std::isnan(a[m]), std::isnan(b[m])) << m;
                    if (!std::isnan(a[m])) {
                        // Logarithms of up to 2^8, rounded some dozen times.
                        ASSERT_NEAR(a[m], b[m], 3e-4)
                            << "k " << path.k << ", m " << m << ", beta " << beta;
                        sum += a[m];
                        shares += b[m] > 0.02 ? 1 : 0;
                        ++strategies;
                    }
                }
                many += shares >= 3 ? 1 : 0;
                if (strategies > 0) {
                    ASSERT_NEAR(sum, 1, 6e-4);
                }
            }
            EXPECT_GT(many, decades < 1 ? 10'000 : 1'000)
                << "statistical power: number of paths with more than two significant strategies";
        }
    }
}

}  // namespace
}  // namespace rtrays
