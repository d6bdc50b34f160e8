// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// A stage in a round.
struct RoundStage {
    std::string name;
    uint32_t chosen_light = SELECT_LIGHT;  ///< of sample_light
};

/// Paths from one end, round after round until all have ended; in every round each of them advances by one vertex.
/// The image is the sum over the passes of an algorithm, which need nothing of each other.
struct Pass {
    std::string name;               ///< "camera" or "light"
    FeatureMask features;           ///< of its kernels and path states
    std::vector<RoundStage> round;  ///< in order; stages that the features do not call for are absent
};

/// The passes of an algorithm (settings.h names them) for a scene and settings with these features.
/// `light_count`: each light is sampled in turn where the features say so.
std::vector<Pass> algorithm_passes(const std::string &algorithm, FeatureMask features, uint32_t light_count);

}  // namespace rtrays
