// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// The stages of one round of light tracing (thesis 2.8): every vertex, the one on the light
/// included, is joined to the camera.
std::vector<RoundStage> light_tracing_round(FeatureMask features);

}  // namespace rtrays
