// SPDX-License-Identifier: MIT
// Rounds and passes of path tracing.
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// Returns the stages of one round of path tracing (thesis 2.7, 3.3.1). `light_count` is the number
/// of lights, each of which is sampled separately if `independent_lights` is on. `adds_hits` is
/// that of `Pass`. `secondary` is the stage that extends or ends paths.
std::vector<RoundStage> path_tracing_round(FeatureMask features, uint32_t light_count,
                                           bool adds_hits = true,
                                           Stage secondary = Stage::extend_path);

/// Returns path tracing as one pass, or with `apart` as one pass per strategy.
std::vector<Pass> path_tracing_passes(FeatureMask features, uint32_t light_count, bool apart);

}  // namespace rtrays
