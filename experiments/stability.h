// SPDX-License-Identifier: MIT
// Stiff and extreme cases against closed forms, the reference in double precision, and each other.
#pragma once

#include <string>
#include <vector>

#include "experiments/runner.h"
#include "experiments/statistics.h"
#include "renderer/base/error.h"
#include "renderer/base/image.h"

namespace rtrays {

/// What an image must come to: R, G, B, and how uncertain they are themselves (variance of the mean
/// of each pixel; none: exact).
struct ExpectedImage {
    Image mean;
    bool noisy = false;  ///< has the layers variance.*
};

/// How batches of independent samples compare with what is expected.
struct StabilityTest {
    double expected = 0, measured = 0;  ///< means over pixels and channels
    Interval difference;                ///< of them, over `expected`
    size_t tests = 0;  ///< blocks of 8 x 8 pixels and the whole, by channel, less those undecided
    size_t undecided = 0;  ///< batches too skewed for a t interval
    size_t rejected = 0;   ///< the interval lies outside expected * (1 +- bound)
    double mse = 0;  ///< of a batch: mean over pixels and channels of (batch - expected)^2, over
                     ///< `expected`^2; without what the noise of the expected image adds on average
    double mse_expected =
        0;                ///< that noise: mean variance over pixels and channels, over `expected`^2
    std::string verdict;  ///< "ok", "off", "undecided" or "imprecise"
};

/// Each test at level `alpha` (two-sided). "imprecise": half of the interval of the mean is more
/// than `within`. Throws `Error` (run failed) for less than 2 batches.
StabilityTest test_stability(const std::vector<Image> &batches, const ExpectedImage &expected,
                             double bound, double within, double alpha);

/// Runs the cases of a profile ("quick", "full", "ci"), each by every algorithm it names, in 32
/// batches. Prints a line for each, writes OUT/stability.json, OUT/stability.md and the images.
/// Cases that an earlier, stopped call finished are not run again. Returns `ExitCode::regression`
/// when one fails. Throws `Error` as the renderers and files do.
ExitCode run_stability(const RunOptions &options);

/// Whether an experiment file is such a suite, by its "$schema".
bool is_stability(const std::filesystem::path &path);

}  // namespace rtrays
