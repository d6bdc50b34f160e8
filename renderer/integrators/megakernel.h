// SPDX-License-Identifier: MIT
// Path tracing with a single kernel instead of a wavefront of stages.
#pragma once

#include "renderer/integrators/pass.h"

namespace rtrays {

/// Returns the passes of path tracing with all stages of each pass replaced by one that traces
/// complete paths, without streams or rounds.
std::vector<Pass> megakernel_passes(std::vector<Pass> path_tracing);

}  // namespace rtrays
