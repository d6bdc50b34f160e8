// SPDX-License-Identifier: MIT
// The kind "sweep": errors of several algorithms while properties of a scene change.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/harness/core/error_parts.h"
#include "experiments/harness/core/experiment.h"
#include "renderer/base/image.h"

namespace rtrays {

/// Makes an experiment that changes a scene and compares algorithms at each step. There are no
/// references: the variance over the seeds is the error of unbiased algorithms. Throws `Error`: bad
/// input.
std::unique_ptr<Experiment> make_sweep(const DescriptionFile &file, const RunOptions &options);

/// Returns an unbiased estimate of the mean squared error from each of several images of
/// independent seeds, divided by classes of pixels. It is the squared difference from the mean of
/// the images, times n / (n - 1). Throws `Error` (bad input) for fewer than two images.
std::vector<ByFirstHit> errors_without_reference(const std::vector<Image> &images,
                                                 const FirstHits &classes);

}  // namespace rtrays
