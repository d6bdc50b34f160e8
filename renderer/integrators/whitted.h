// SPDX-License-Identifier: MIT
// Rounds of Whitted's ray tracing.
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// Returns the stages of one round of Whitted's ray tracing (thesis 2.7.6, 3.3.1): those of path
/// tracing with all ideal reflections and refractions as secondary rays. The paths found are E S* L
/// and E S* D L.
std::vector<RoundStage> whitted_round(FeatureMask features, uint32_t light_count);

}  // namespace rtrays
