// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// The passes of full bidirectional path tracing (thesis 2.69; Veach 1997, 10): those of the
/// truncated kind, between which the first `light_vertices` of each light path are kept; all the
/// camera path's vertices are joined to them. `camera`, `light`: the features of either pass;
/// `apart`: joins and other strategies of the camera's paths are passes of their own.
std::vector<Pass> bdpt_passes(FeatureMask camera, FeatureMask light, uint32_t light_count,
                              uint32_t light_vertices, bool apart);

}  // namespace rtrays
