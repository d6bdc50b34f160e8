// SPDX-License-Identifier: MIT
// The kind "convergence_control": savings and bias of convergence control (thesis 3.3.7), compared
// with equal renders without it.
#pragma once

#include <memory>
#include <vector>

#include "experiments/harness/core/experiment.h"
#include "renderer/base/image.h"

namespace rtrays {

/// Cost and image of one render.
struct ControlledRender {
    Image image;
    double paths = 0;    ///< number of camera paths
    double rays = 0;     ///< number of rays of camera and light paths
    double seconds = 0;  ///< device time
    double live = 1;     ///< share of the pixels that were not stopped
};

/// Compares renders with and without control, and returns {"paths", "rays", "seconds", "live",
/// "rmse", "rmse_without", "efficiency", "bias"}. `with[i]` and `without[i]` have the same seed, so
/// they share samples until control stops a pixel. Their difference therefore has the bias and
/// little noise.
///
/// * "paths", "rays" and "seconds" are ratios, with control over without. "seconds" is a median
///   with its 95 % interval.
/// * "efficiency" compares control with evenly spread samples, whose mean squared error falls as
///   1 / rays. It is the ratio of the rays that both need for the error that control reaches:
///   (MSE x rays) without over with, as a geometric mean with its 99 % interval.
/// * "bias" has "mean", the mean difference over pixels and channels relative to the mean of
///   `without`, with its 99 % interval (Student's t over the seeds). It also has the agreement test
///   over blocks of 16 x 16 pixels and the full image, by channel: "tests", "rejected" (Holm,
///   0.01), "undecided" (too skewed to be tested), "largest_z" and "largest_z_at".
///
/// Throws `Error` (run failed) for fewer than 8 seeds.
Json compare_control(const std::vector<ControlledRender> &with,
                     const std::vector<ControlledRender> &without, const Image &reference);

/// Makes an experiment that renders every scene of the profile with every curve, without control
/// and with each error limit. Throws `Error`: bad input, reference missing.
std::unique_ptr<Experiment> make_convergence_control(const DescriptionFile &file,
                                                     const RunOptions &options);

}  // namespace rtrays
