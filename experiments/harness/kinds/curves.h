// SPDX-License-Identifier: MIT
// The kind "curves": error over samples and over time, and throughput.
#pragma once

#include <memory>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

/// Makes an experiment that renders every curve with several seeds and compares it with the
/// reference. Throws `Error`: bad input, reference missing.
std::unique_ptr<Experiment> make_curves(const DescriptionFile &file, const RunOptions &options);

}  // namespace rtrays
