// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// The passes of path tracing, each by one stage that traces whole paths: no streams, no rounds.
std::vector<Pass> megakernel_passes(std::vector<Pass> path_tracing);

}  // namespace rtrays
