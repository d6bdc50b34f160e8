// SPDX-License-Identifier: MIT
// The table of all kinds of experiments.
#pragma once

#include <vector>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

/// Returns all kinds. A new kind is one more line of this table.
const std::vector<Kind> &experiment_kinds();

}  // namespace rtrays
