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

/// The stages of one round of path tracing (thesis 2.7, 3.3.1), in order: every active path advances by one vertex.
/// Stages that the features do not call for are absent.
/// `light_count`: each of them is sampled in turn where the features say so.
std::vector<RoundStage> path_tracing_round(FeatureMask features, uint32_t light_count);

}  // namespace rtrays
