// SPDX-License-Identifier: MIT
// The round of ray casting.
#pragma once

#include "renderer/integrators/pass.h"

namespace rtrays {

/// Returns the stages of ray casting's only round: those of path tracing without secondary rays.
/// The image shows the first surfaces that the camera sees, with the light they emit and the light
/// that reaches them directly from every light.
std::vector<RoundStage> ray_casting_round(FeatureMask features, uint32_t light_count);

}  // namespace rtrays
