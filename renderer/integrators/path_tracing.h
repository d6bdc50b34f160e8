// SPDX-License-Identifier: MIT
// Rounds and passes of paths from the camera.
#pragma once

#include "renderer/integrators/pass.h"

namespace rtrays {

/// Returns the stages of one round of paths from the camera (thesis 2.7, 3.3.1). `light_count` is
/// that of `PassRequest`, `adds_hits` that of `Pass`. `secondary` is the stage that extends or ends
/// paths.
std::vector<RoundStage> camera_round(FeatureMask features, uint32_t light_count,
                                     bool adds_hits = true, Stage secondary = Stage::extend_path);

/// Returns the pass of paths from the camera, or one pass for each strategy that ends them.
std::vector<Pass> camera_passes(const PassRequest &request);

}  // namespace rtrays
