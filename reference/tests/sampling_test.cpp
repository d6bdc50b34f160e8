// SPDX-License-Identifier: MIT
#include "reference/sampling.h"

#include <gtest/gtest.h>

#include <set>

#include "reference/bsdf.h"
#include "reference/tests/statistics.h"
#include "renderer/base/error.h"
#include "renderer/testing/chi_square.h"

namespace rtrays::reference {
namespace {

constexpr int samples = 1000000;
constexpr int cells = 16;
const Eigen::Vector2d no_uv = Eigen::Vector2d::Zero();

size_t cell(double unit) {
    return static_cast<size_t>(std::min(unit, 0x1.fffffep-1) * cells);
}

/// Counts the points of the unit square in a grid of cells x cells.
template <class Draw>
std::vector<uint64_t> count_square(const Draw &draw) {
    std::vector<uint64_t> counts(cells * cells, 0);
    for (int i = 0; i < samples; ++i) {
        const auto [x, y] = draw(i);
        ++counts[cell(x) * cells + cell(y)];
    }
    return counts;
}

double uniform_p_value(const std::vector<uint64_t> &counts) {
    const double expected = samples / static_cast<double>(counts.size());
    return chi_square_p(counts, std::vector<double>(counts.size(), expected));
}

/// Returns (cos^2, phi / 2 pi) of a direction. It is uniform on the square for a cosine-distributed
/// direction.
std::pair<double, double> to_square(const Vec3 &w) {
    const double phi = std::atan2(w.y(), w.x()) / (2.0 * pi);
    return {w.z() * w.z(), phi < 0.0 ? phi + 1.0 : phi};
}

TEST(Sampling, every_sampler_has_the_density_it_claims) {
    std::vector<Comparison> suite;
    const auto add = [&](const char *name, const std::vector<uint64_t> &counts) {
        suite.push_back({name, uniform_p_value(counts)});
    };
    Rng rng(11, 0, 0);
    add("one generator",
        count_square([&](int) { return std::make_pair(rng.uniform(), rng.uniform()); }));
    // Neighbouring paths must not be correlated by their seeding.
    const auto first = [](uint64_t seed, uint64_t pixel, uint64_t sample) {
        return Rng(seed, pixel, sample).uniform();
    };
    add("samples of a pixel", count_square([&](int i) {
            return std::make_pair(first(1, 5, static_cast<uint64_t>(i)),
                                  first(1, 5, static_cast<uint64_t>(i) + 1));
        }));
    add("pixels of a sample", count_square([&](int i) {
            return std::make_pair(first(1, static_cast<uint64_t>(i), 9),
                                  first(1, static_cast<uint64_t>(i) + 1, 9));
        }));
    add("two seeds", count_square([&](int i) {
            return std::make_pair(first(1, 3, static_cast<uint64_t>(i)),
                                  first(2, 3, static_cast<uint64_t>(i)));
        }));
    add("cosine hemisphere",
        count_square([&](int) { return to_square(sample_cosine_hemisphere(rng)); }));

    const Lambert lambert(Spectrum(0.2, 0.5, 0.8));
    const Vec3 below = Vec3(0.3, 0.4, -0.5).normalized();
    add("Lambert from below", count_square([&](int) {
            const auto sample = lambert.sample(below, no_uv, rng);
            EXPECT_LT(sample->wi.z(), 0.0);
            return to_square(sample->wi);
        }));

    // The squared sum of both barycentrics and the share of the second are uniform on the square.
    add("triangle", count_square([&](int) {
            const Eigen::Vector2d b = sample_triangle(rng);
            const double root = b.sum();
            return std::make_pair(root * root, root > 0.0 ? b.y() / root : 0.0);
        }));

    const std::vector<double> weights{0.0, 1.0, 5.0, 1e-3, 2.0, 0.0, 100.0, 7.5};
    const AliasTable table(weights);
    std::vector<uint64_t> counts(weights.size(), 0);
    std::vector<double> expected;
    double total = 0.0;
    for (int i = 0; i < samples; ++i) {
        ++counts[table.sample(rng)];
    }
    for (const double weight : weights) {
        total += weight;
    }
    for (size_t i = 0; i < weights.size(); ++i) {
        EXPECT_DOUBLE_EQ(table.probability(i), weights[i] / total);
        expected.push_back(samples * weights[i] / total);
    }
    EXPECT_EQ(counts[0] + counts[5], 0u);
    suite.push_back({"alias table", chi_square_p(counts, expected)});

    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(Sampling, the_chi_square_test_sees_a_two_percent_error) {
    // The density is cos^1.02 instead of cos, so cos^2.02 is uniform and cos^2 is not.
    Rng rng(12, 0, 0);
    const auto counts = count_square(
        [&](int) { return std::make_pair(std::pow(rng.uniform(), 2.0 / 2.02), rng.uniform()); });
    EXPECT_LT(uniform_p_value(counts), 0.01 * family_alpha);
}

TEST(Rng, starts_differ_for_neighbouring_seeds_pixels_and_samples) {
    std::set<uint64_t> outputs;
    for (uint64_t seed = 0; seed < 8; ++seed) {
        for (uint64_t pixel = 0; pixel < 64; ++pixel) {
            for (uint64_t sample = 0; sample < 64; ++sample) {
                outputs.insert(Rng(seed, pixel, sample).next_bits());
            }
        }
    }
    EXPECT_EQ(outputs.size(), 8u * 64u * 64u);
}

TEST(Lambert, evaluate_pdf_and_sample_agree) {
    const Lambert lambert(Spectrum(0.2, 0.5, 0.8));
    Rng rng(13, 0, 0);
    const Vec3 wo = Vec3(0.1, 0.2, 0.7).normalized();
    for (int i = 0; i < 1000; ++i) {
        const auto sample = lambert.sample(wo, no_uv, rng);
        ASSERT_TRUE(sample);
        EXPECT_NEAR(sample->wi.norm(), 1.0, 1e-14);
        EXPECT_DOUBLE_EQ(sample->pdf_w, lambert.pdf_w(sample->wi, wo, no_uv));
        const Spectrum weight =
            lambert.evaluate(sample->wi, wo, no_uv) * std::abs(sample->wi.z()) / sample->pdf_w;
        EXPECT_TRUE(weight.isApprox(sample->weight, 1e-14));
        EXPECT_TRUE((lambert.evaluate(-sample->wi, wo, no_uv) == 0.0).all());  // no transmission
        EXPECT_EQ(lambert.pdf_w(-sample->wi, wo, no_uv), 0.0);
    }
}

TEST(PowerHeuristic, sums_to_one_and_survives_extremes) {
    EXPECT_DOUBLE_EQ(power_heuristic(3.0, 4.0) + power_heuristic(4.0, 3.0), 1.0);
    EXPECT_EQ(power_heuristic(1e-300, 1e300), 0.0);
    EXPECT_EQ(power_heuristic(1e300, 1e-300), 1.0);
    EXPECT_EQ(power_heuristic(1.0, 0.0), 1.0);
}

TEST(AliasTable, refuses_weights_that_are_no_distribution) {
    EXPECT_THROW(AliasTable({0.0, 0.0}), Error);
    EXPECT_THROW(AliasTable({1.0, -1.0, 2.0}), Error);
    EXPECT_THROW(AliasTable({1.0, std::nan("")}), Error);
    EXPECT_THROW(AliasTable(std::vector<double>{}), Error);
}

}  // namespace
}  // namespace rtrays::reference
