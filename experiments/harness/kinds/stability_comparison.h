// SPDX-License-Identifier: MIT
// Compares batches of a stiff case with its expected image.
#pragma once

#include <string>
#include <vector>

#include "experiments/harness/core/statistics.h"
#include "renderer/base/image.h"

namespace rtrays {

/// Side of the tested blocks in pixels.
constexpr int stability_block_size = 8;

/// Expected image. It is exact, or has layers with the variance of the mean of each pixel.
struct ExpectedImage {
    Image mean;
    bool noisy = false;  ///< whether `mean` has the layers variance.*
};

/// Comparison of batches of independent samples with the expected image.
struct StabilityTest {
    double expected = 0, measured = 0;  ///< means over pixels and channels
    Interval difference;                ///< (measured - expected) / expected
    /// Tests of the blocks of 8 x 8 pixels and the full image, by channel, without the undecided.
    size_t tests = 0;
    size_t undecided = 0;  ///< tests that do not pass, with batches too skewed for a t interval
    size_t rejected = 0;   ///< tests whose interval is outside expected * (1 +- bound)
    /// Mean squared error of a batch over pixels and channels, divided by `expected`^2. The average
    /// contribution of the expected image's noise is subtracted.
    double mse = 0;
    /// Noise of the expected image: mean variance of pixels and channels over `expected`^2.
    double mse_expected = 0;
    std::string verdict;  ///< "ok", "off", "undecided" or "imprecise"
};

/// Tests batches against the expected image. Each test has the level `alpha` (two-sided). The
/// verdict is "imprecise" if the half width of the mean's 99 % interval is more than `within`,
/// relative to `expected`. Throws `Error` (run failed) for fewer than 2 batches.
StabilityTest test_stability(const std::vector<Image> &batches, const ExpectedImage &expected,
                             double bound, double within, double alpha);

/// Returns the mean squared error of the pixels, averaged over the batches. A noisy expected image
/// adds its variance on average, so this variance is subtracted.
double mean_squared_error(const std::vector<Image> &images, const ExpectedImage &expected);

/// Number of tests of a square image with `size` pixels along a side.
size_t tests_of(int size);

}  // namespace rtrays
