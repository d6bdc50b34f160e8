// SPDX-License-Identifier: MIT
// Tests stiff and extreme cases against closed forms, the double-precision reference or each other.
#pragma once

#include <string>
#include <vector>

#include "experiments/harness/core/statistics.h"
#include "experiments/harness/kinds/curves.h"
#include "renderer/base/error.h"
#include "renderer/base/image.h"

namespace rtrays {

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

/// Runs the cases of a profile ("quick", "full", "ci"), each with every algorithm it names, in 32
/// batches. Prints one line for each, and writes OUT/stability.json, OUT/stability.md and the
/// images. Cases that an interrupted call finished are not run again. Returns
/// `ExitCode::regression` if a case fails. Throws the errors of the renderers and the files.
ExitCode run_stability(const RunOptions &options);

/// Returns whether an experiment file is a stability suite, by its "$schema".
bool is_stability(const std::filesystem::path &path);

}  // namespace rtrays
