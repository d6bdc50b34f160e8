// SPDX-License-Identifier: MIT
// Rounds of light tracing.
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// Returns the stages of one round of light tracing (thesis 2.8). Every vertex of a light path,
/// including the one on the light, is connected to the camera.
std::vector<RoundStage> light_tracing_round(FeatureMask features);

}  // namespace rtrays
