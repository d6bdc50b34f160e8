// SPDX-License-Identifier: MIT
// Scatter guides: from where light arrives, for camera paths behind mirrors and glass
// (kernels/bsdf/guided_scattering.h).
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/compile/compile_scene.h"
#include "renderer/shared/guide_layout.h"
#include "renderer/shared/light_path_trials.h"

namespace rtrays {

/// A scatter guide in the layout of shared/guide_layout.h.
struct ScatterGuide {
    std::vector<uint32_t> words;
};

/// Returns whether camera paths may be guided in a scene: it has a mirror or smooth glass, and an
/// opaque material with a diffuse component.
bool is_scatter_guidable(const CompiledScene &scene);

/// Returns the guide that hits of light paths train. Those of a side are divided at the median of
/// the coordinate in which they extend farthest, until a cell has less than 64 hits, or more if
/// there would be over 4,096 cells. A table has 19/20 of its probability in proportion to the power
/// that arrives, smoothed over neighbouring bins, and 1/20 uniformly. A side with less than 16 hits
/// has none. Hits that are not finite, or have no power, are left out.
ScatterGuide make_scatter_guide(const std::vector<TrainingHit> &hits);

}  // namespace rtrays
