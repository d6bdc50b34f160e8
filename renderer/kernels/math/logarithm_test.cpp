// SPDX-License-Identifier: MIT
// Tests the logarithms and powers of MIS weights against double precision.
#include "renderer/kernels/math/logarithm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace rtrays {
namespace {

using Random = std::mt19937_64;

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
