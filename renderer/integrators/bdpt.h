// SPDX-License-Identifier: MIT
// Passes of full bidirectional path tracing.
#pragma once

#include "renderer/integrators/algorithm.h"

namespace rtrays {

/// Returns the passes of full bidirectional path tracing (thesis (2.69); Veach 1997, chapter 10).
/// They extend those of truncated bidirectional path tracing: the first `light_vertices` vertices
/// of each light path are stored, and every vertex of the camera path is connected to them.
/// `camera` and `light` are the features of the two kinds of pass. With `apart`, connections and
/// the other strategies of the camera paths are separate passes.
std::vector<Pass> bdpt_passes(FeatureMask camera, FeatureMask light, uint32_t light_count,
                              uint32_t light_vertices, bool apart);

}  // namespace rtrays
