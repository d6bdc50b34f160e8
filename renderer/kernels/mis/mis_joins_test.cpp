// SPDX-License-Identifier: MIT
// Tests the MIS weights of bidirectional path tracing. The stages accumulate the weights of all
// strategies of a path vertex by vertex. They must agree with weights from the densities of the
// full path in double precision, and sum to 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "renderer/kernels/light/mis.h"

namespace rtrays {
namespace {

using Random = std::mt19937_64;

/// Densities along a path x_0 ... x_k per projected solid angle. `forward[i]` is from x_i to
/// x_{i+1}, away from the camera; `back[i]` is from x_i to x_{i-1}. For deltas, they are discrete
/// probabilities times the ratio of the two solid angles.
struct Path {
    size_t k = 0;
    std::vector<double> forward, back, geometry;  ///< `geometry[i]`: G of x_i and x_{i+1}
    std::vector<bool> delta;
    double first = 0, light_paths = 0;       ///< P_1, n_L
    double origin = 0, explicit_origin = 0;  ///< p_o of emission and of light sampling
    double direction = 0;                    ///< p_d
    bool hittable = true;                    ///< whether paths can hit the light
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
    path.forward.resize(path.k);
    path.back.resize(path.k);
    path.geometry.resize(path.k);
    path.delta.resize(path.k);
    for (size_t i = 1; i < path.k; ++i) {
        path.delta[i] = random() % 4 == 0;
        path.forward[i] = path.delta[i] ? uniform(random) : density();
        path.back[i] = path.delta[i] ? path.forward[i] * spread(0.4) : density();
        path.geometry[i] = density();
    }
    path.first = density();
    path.light_paths = std::floor(1 + spread(1) * 1e1);
    path.origin = density();
    path.explicit_origin = random() % 2 == 0 ? path.origin : density();
    path.direction = density();
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
        double log_density = m == 0 ? std::log2(p.light_paths) : std::log2(p.first);
        for (size_t i = 1; i < m; ++i) {
            log_density += std::log2(p.forward[i]) + std::log2(p.geometry[i]);
        }
        if (m == p.k - 1) {
            log_density += std::log2(p.explicit_origin);
        } else if (m < p.k - 1) {
            log_density +=
                std::log2(p.origin) + std::log2(p.direction) + std::log2(p.geometry[p.k - 1]);
            for (size_t i = p.k - 1; i >= m + 2; --i) {
                log_density += std::log2(p.back[i]) + std::log2(p.geometry[i - 1]);
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

/// MIS state of a path at its arrival at a vertex.
struct Arrival {
    float strategies = 0, arrival = 0;
};

/// Returns log2 of A at the end of a ray that leaves a vertex with this density. The density
/// includes G, so distance and cosine are 1.
float arrive(bool delta, double density) {
    return log_inverse_pdf_a(delta ? INFINITY : static_cast<float>(density), 1.0f, 1.0f);
}

/// Returns the weights as the stages compute them.
std::vector<double> shipped(const Path &p, float beta) {
    std::vector<Arrival> camera(p.k + 1), light(p.k + 1);
    camera[1] = {-INFINITY, log2_of(p.light_paths / p.first)};
    for (size_t i = 1; i < p.k; ++i) {
        camera[i + 1] = {continue_strategies(camera[i].strategies, camera[i].arrival, p.delta[i],
                                             p.delta[i] ? 0.0f : log2_of(p.forward[i]),
                                             log2_of(p.back[i] / p.forward[i]), beta),
                         arrive(p.delta[i], p.forward[i] * p.geometry[i])};
    }
    light[p.k - 1] = {
        p.hittable ? -log2_of(p.origin * p.direction) : -INFINITY,
        log2_of(p.explicit_origin / p.origin) - log2_of(p.direction * p.geometry[p.k - 1])};
    for (size_t i = p.k - 1; i >= 2; --i) {
        light[i - 1] = {continue_strategies(light[i].strategies, light[i].arrival, p.delta[i],
                                            p.delta[i] ? 0.0f : log2_of(p.back[i]),
                                            log2_of(p.forward[i] / p.back[i]), beta),
                        arrive(p.delta[i], p.back[i] * p.geometry[i - 1])};
    }
    const auto before = [&](const Arrival &at, double density) {
        return strategies_before(at.strategies, at.arrival, log2_of(density), beta);
    };
    std::vector<double> weights(p.k + 1, none);
    if (!p.delta[1]) {
        weights[0] = static_cast<double>(join_weight(
            -INFINITY, log2_of(p.first / p.light_paths) + before(light[1], p.forward[1]), beta));
    }
    for (size_t m = 1; m + 2 <= p.k; ++m) {
        if (!p.delta[m] && !p.delta[m + 1]) {
            weights[m] = static_cast<double>(join_weight(
                log2_of(p.back[m + 1] * p.geometry[m]) + before(camera[m], p.back[m]),
                log2_of(p.forward[m] * p.geometry[m]) + before(light[m + 1], p.forward[m + 1]),
                beta));
        }
    }
    const size_t last = p.k - 1;
    const double by_implicit = p.forward[last] * p.geometry[last] / p.explicit_origin;
    if (!p.delta[last]) {
        const float arriving =
            log2_of(p.direction * p.geometry[last]) + log2_of(p.origin / p.explicit_origin);
        weights[last] = static_cast<double>(
            camera_path_weight(p.hittable ? static_cast<float>(by_implicit) : 0.0f,
                               arriving + before(camera[last], p.back[last]), beta));
    }
    if (p.hittable) {
        weights[p.k] = static_cast<double>(
            camera_path_weight(p.delta[last] ? 0.0f : static_cast<float>(1 / by_implicit),
                               camera[p.k].strategies + log2_of(p.origin * p.direction), beta));
    }
    return weights;
}

TEST(JoinWeights, OfAPathAgreeAndSumToOne) {
    Random random(1997);
    for (const float beta : {1.0f, 2.0f, 1.5f}) {
        for (const double decades : {0.3, 2.0}) {
            int many = 0;
            for (int trial = 0; trial < 50'000; ++trial) {
                const Path path = random_path(random, decades);
                const std::vector<double> a = shipped(path, beta),
                                          b = expected(path, static_cast<double>(beta));
                double sum = 0;
                int shares = 0, techniques = 0;
                for (size_t m = 0; m <= path.k; ++m) {
                    ASSERT_EQ(std::isnan(a[m]), std::isnan(b[m])) << m;
                    if (!std::isnan(a[m])) {
                        // Logarithms of up to 2^8, rounded some dozen times.
                        ASSERT_NEAR(a[m], b[m], 3e-4)
                            << "k " << path.k << ", m " << m << ", beta " << beta;
                        sum += a[m];
                        shares += b[m] > 0.02 ? 1 : 0;
                        ++techniques;
                    }
                }
                many += shares >= 3 ? 1 : 0;
                if (techniques > 0) {
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
