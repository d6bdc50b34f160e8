// SPDX-License-Identifier: MIT
// The kind "sweep": errors of several algorithms while properties of a scene change.
#pragma once

#include <memory>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

/// Makes an experiment that changes scenes and compares algorithms at each step, without
/// references. Throws `Error`: bad input.
std::unique_ptr<Experiment> make_sweep(const DescriptionFile &file, const RunOptions &options);

}  // namespace rtrays
