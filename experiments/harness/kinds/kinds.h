// SPDX-License-Identifier: MIT
// The table of all kinds of experiments.
#pragma once

#include <vector>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

/// Returns all kinds. docs/architecture.md lists what a new kind consists of.
const std::vector<Kind> &experiment_kinds();

}  // namespace rtrays
