// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// The stages of one round of path tracing (thesis 2.7, 3.3.1).
/// `light_count`: each of them is sampled in turn where the features say so. `adds_hits`: see
/// `Pass`. `secondary`: the stage that moves paths on, or ends them.
std::vector<RoundStage> path_tracing_round(FeatureMask features, uint32_t light_count,
                                           bool adds_hits = true,
                                           const std::string &secondary = "extend_path");

/// Path tracing as one pass, or `apart` as one for each strategy.
std::vector<Pass> path_tracing_passes(FeatureMask features, uint32_t light_count, bool apart);

}  // namespace rtrays
