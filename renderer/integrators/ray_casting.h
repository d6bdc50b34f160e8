// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// The stages of the one round of ray casting: those of path tracing with the block of secondary
/// rays switched off (thesis 3.3.1). What the camera sees first is shown with the light it emits
/// and that which reaches it from every light.
std::vector<RoundStage> ray_casting_round(FeatureMask features, uint32_t light_count);

}  // namespace rtrays
