// SPDX-License-Identifier: MIT
#include "reference/film.h"

#include <gtest/gtest.h>

#include <cstring>

#include "reference/rng.h"

namespace rtrays::reference {
namespace {

TEST(PixelMoments, average_200k_samples_of_a_tenth_to_a_tenth) {
    constexpr uint64_t count = 200000;
    PixelMoments moments;
    for (uint64_t i = 0; i < count; ++i) {
        moments.add(Spectrum::Constant(0.1), i);
    }
    EXPECT_EQ(moments.mean(count)[0], 0.1);  // exact, not just within 1e-6
    EXPECT_LT(moments.variance_of_mean(count)[0], 1e-36);
}

TEST(PixelMoments, survive_a_firefly) {
    // One sample of 1e8 among 200k ones. A plain double sum keeps the mean, but its square would
    // cancel in the variance.
    constexpr uint64_t count = 200000;
    PixelMoments moments;
    for (uint64_t i = 0; i < count; ++i) {
        moments.add(Spectrum::Constant(i == 1234 ? 1e8 : 1.0), i);
    }
    const double n = count;
    EXPECT_DOUBLE_EQ(moments.mean(count)[1], (1e8 + n - 1.0) / n);
    const double expected = (1e8 - 1.0) * (1e8 - 1.0) * (n - 1.0) / n / (n * (n - 1.0));
    EXPECT_NEAR(moments.variance_of_mean(count)[1] / expected, 1.0, 1e-10);
}

TEST(PixelMoments, know_the_variance_around_a_large_mean) {
    // The samples are uniform on [1e6, 1e6 + 1]. The textbook formula would lose every digit in
    // float and most digits in double.
    constexpr uint64_t count = 100000;
    PixelMoments moments;
    Rng rng(7, 0, 0);
    for (uint64_t i = 0; i < count; ++i) {
        moments.add(Spectrum::Constant(1e6 + rng.uniform()), i);
    }
    const double variance = moments.variance_of_mean(count)[2] * static_cast<double>(count);
    EXPECT_NEAR(variance, 1.0 / 12.0, 1.0 / 12.0 * 0.02);  // 7 standard errors
}

TEST(Film, develops_means_variances_and_counts) {
    Film film(2, 1, 10);
    film.pixels[1].add(Spectrum(1.0, 2.0, 3.0), 0);
    film.pixels[1].add(Spectrum(3.0, 2.0, 7.0), 1);
    film.end = 12;
    const Image image = film.develop();
    EXPECT_EQ(image.channel("R")[1], 2.0f);
    EXPECT_EQ(image.channel("B")[1], 5.0f);
    EXPECT_EQ(image.channel("variance.R")[1], 1.0f);
    EXPECT_EQ(image.channel("variance.G")[1], 0.0f);
    EXPECT_EQ(image.channel("variance.B")[1], 4.0f);
    EXPECT_EQ(image.channel("samples")[0], 2.0f);
}

}  // namespace
}  // namespace rtrays::reference
