// SPDX-License-Identifier: MIT
// Tests errors without a reference by hand.
#include "experiments/harness/kinds/unreferenced.h"

#include <gtest/gtest.h>

#include "experiments/harness/core/one_row.h"
#include "renderer/base/error.h"

namespace rtrays {
namespace {

using test::row;

const FirstHits classes{FirstHit::other, FirstHit::delta};

TEST(Unreferenced, ErrorsAreVariancesByClass) {
    // The variances of {1, 2, 6} and {0, 0, 3} are 7 and 3; the images have two pixels.
    const auto errors = errors_without_reference({row({1, 0}), row({2, 0}), row({6, 3})}, classes);
    ByFirstHit mean{};
    for (const ByFirstHit &error : errors) {
        for (size_t i = 0; i < mean.size(); ++i) {
            mean[i] += error[i] / 3;
        }
    }
    EXPECT_DOUBLE_EQ(mean[static_cast<size_t>(FirstHit::other)], 3.5);
    EXPECT_DOUBLE_EQ(mean[static_cast<size_t>(FirstHit::delta)], 1.5);
    EXPECT_EQ(mean[static_cast<size_t>(FirstHit::light_behind_delta)], 0);
    EXPECT_DOUBLE_EQ(errors[2][static_cast<size_t>(FirstHit::other)], 9.0 * 1.5 / 2);
}

TEST(Unreferenced, OneImageHasNoError) {
    EXPECT_THROW(errors_without_reference({row({1, 2})}, classes), Error);
}

}  // namespace
}  // namespace rtrays
