// SPDX-License-Identifier: MIT
// The pass of light paths that are connected to the camera.
#pragma once

#include "renderer/integrators/pass.h"

namespace rtrays {

/// Returns the pass of light paths (thesis 2.8). Every vertex of a light path, including the one on
/// the light, is connected to the camera. If `weighted`, paths from the camera sample the same
/// light, and the contributions have MIS weights.
Pass light_pass(const PassRequest &request, bool weighted);

}  // namespace rtrays
