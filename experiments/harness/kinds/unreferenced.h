// SPDX-License-Identifier: MIT
// Comparisons of unbiased algorithms without references: the variance over the seeds is the error.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/harness/core/description.h"
#include "experiments/harness/core/error_parts.h"
#include "experiments/harness/core/experiment.h"
#include "renderer/base/image.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// A scene that all curves render: one row of the document.
struct UnreferencedCase {
    std::string file;  ///< name of the file that keeps the row while others are measured
    Json keys;         ///< keys of the row that name the case
    std::function<Scene()> load;
};

/// Returns an experiment that renders every case with the curves of a file. `shown` are the keys of
/// the file that its document repeats. `plan` are the lines of the plan that name the cases. Throws
/// `Error` (bad input) if the file has no such profile.
std::unique_ptr<Experiment> make_unreferenced(const DescriptionFile &file,
                                              const std::string &profile,
                                              const std::vector<std::string> &shown,
                                              std::vector<UnreferencedCase> cases,
                                              const std::string &plan);

/// Returns an unbiased estimate of the mean squared error from each of several images of
/// independent seeds, divided by classes of pixels. It is the squared difference from the mean of
/// the images, times n / (n - 1). Throws `Error` (bad input) for fewer than two images.
std::vector<ByFirstHit> errors_without_reference(const std::vector<Image> &images,
                                                 const FirstHits &classes);

}  // namespace rtrays
