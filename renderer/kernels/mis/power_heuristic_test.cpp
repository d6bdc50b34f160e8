// SPDX-License-Identifier: MIT
// Tests the weight of one of two strategies.
#include "renderer/kernels/mis/power_heuristic.h"

#include <gtest/gtest.h>

#include <limits>

namespace rtrays {
namespace {

TEST(PowerHeuristic, StaysInRangeAndSumsToOne) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float beta : {1.0f, 2.0f, 3.5f}) {
        for (const float ratio : {0.0f, 1e-38f, 0.1f, 1.0f, 7.0f, 1e38f, infinity}) {
            const float one = power_heuristic(ratio, beta);
            const float other = power_heuristic(1.0f / ratio, beta);
            EXPECT_NEAR(one + other, 1.0f, 1e-6f) << ratio;
            const float log_ratio = ratio == infinity ? infinity : log2_of(ratio);
            EXPECT_NEAR(power_heuristic_of_log(log_ratio, beta), one, 1e-6f) << ratio;
        }
    }
}

}  // namespace
}  // namespace rtrays
