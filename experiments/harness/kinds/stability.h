// SPDX-License-Identifier: MIT
// The kind "stability": stiff and extreme cases against closed forms, the double-precision
// reference or each other.
#pragma once

#include <memory>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

/// Makes an experiment that renders every case of the profile with every algorithm that the case
/// names, in 32 batches. Throws `Error` (bad input).
std::unique_ptr<Experiment> make_stability(const DescriptionFile &file, const RunOptions &options);

}  // namespace rtrays
