// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// The stages of one round of Whitted's ray tracing (thesis 2.7.6, 3.3.1): those of path tracing,
/// in which secondary rays are ideal reflections and refractions, all of them. Paths are E S* L and
/// E S* D L.
std::vector<RoundStage> whitted_round(FeatureMask features, uint32_t light_count);

}  // namespace rtrays
