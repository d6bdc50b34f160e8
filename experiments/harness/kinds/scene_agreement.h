// SPDX-License-Identifier: MIT
// The kind "agreement": does the renderer agree with the reference on many small scenes?
#pragma once

#include <memory>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

/// Makes an experiment that renders every scene with the reference and with each algorithm. It
/// tests the agreement (agreement.h) of each algorithm with the reference, and of any two
/// algorithms that see all light. The level is divided among all rows. The mean images are written
/// as arrays in OUT/images. Throws `Error` (bad input).
std::unique_ptr<Experiment> make_agreement(const DescriptionFile &file, const RunOptions &options);

}  // namespace rtrays
