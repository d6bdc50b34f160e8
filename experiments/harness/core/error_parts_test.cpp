// SPDX-License-Identifier: MIT
// Tests the parts of an error by hand.
#include "experiments/harness/core/error_parts.h"

#include <gtest/gtest.h>

#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/one_row.h"
#include "renderer/base/error.h"

namespace rtrays {
namespace {

using test::row;

const FirstHits classes{FirstHit::other, FirstHit::light_behind_delta, FirstHit::other,
                        FirstHit::delta};
const Image reference = row({0.0f, 18.0f, 1.0f, 0.5f});
const Image image = row({1.0f, 20.0f, 1.5f, 0.0f});

TEST(ErrorParts, AreSquaresOverTheFullImageAndAddUp) {
    const ByFirstHit parts = divide_mse(image, reference, classes);
    EXPECT_EQ(parts, (ByFirstHit{4.0 / 4, 0.25 / 4, 1.25 / 4}));
    EXPECT_DOUBLE_EQ(parts[0] + parts[1] + parts[2], compute_metrics(image, reference).mse);
}

TEST(ErrorParts, SharesOfPixels) {
    EXPECT_EQ(pixel_shares(classes), (ByFirstHit{0.25, 0.25, 0.5}));
}

TEST(ErrorParts, APictureHasOneChannelOfEachPixel) {
    const Image picture = picture_of(classes, 4, 1);
    EXPECT_EQ(picture.channel("R"), (std::vector<float>{0, 1, 0, 0}));
    EXPECT_EQ(picture.channel("G"), (std::vector<float>{0, 0, 0, 1}));
    EXPECT_EQ(picture.channel("B"), (std::vector<float>{1, 0, 1, 0}));
}

TEST(ErrorParts, RoundTrip) {
    const ByFirstHit numbers{0.1, 0.2, 0.3};
    EXPECT_EQ(parse_by_first_hit(to_json(numbers)), numbers);
}

TEST(ErrorParts, OtherSizesAreRefused) {
    EXPECT_THROW(divide_mse(image, row({1.0f}), classes), Error);
    EXPECT_THROW(divide_mse(image, reference, {FirstHit::other}), Error);
}

}  // namespace
}  // namespace rtrays
