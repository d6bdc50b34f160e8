// SPDX-License-Identifier: MIT
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

std::vector<RoundStage> path_tracing_round(FeatureMask features, uint32_t light_count,
                                           bool adds_hits, Stage secondary) {
    std::vector<RoundStage> round = {
        {Stage::generate_camera_rays}, {Stage::begin_round}, {Stage::intersect_nearest}};
    const bool emitters = features.has(Feature::area_lights) ||
                          features.has(Feature::shape_lights) ||
                          features.has(Feature::infinite_lights);
    if ((emitters && adds_hits) || features.has(Feature::light_strategy)) {
        // Adds implicit paths and emitters seen directly, and sets the ratio R_0 of light/mis.h.
        round.push_back({Stage::evaluate_emission});
    }
    if (features.has(Feature::explicit_light)) {
        const bool independent = features.has(Feature::independent_lights);
        for (uint32_t light = 0; light < (independent ? light_count : 1u); ++light) {
            round.push_back({Stage::sample_light, independent ? light : SELECT_LIGHT});
            round.push_back({Stage::intersect_any});
            round.push_back({Stage::end_shadow_rays});
        }
    }
    round.push_back({secondary});
    round.push_back({Stage::end_round});
    return round;
}

std::vector<Pass> path_tracing_passes(FeatureMask features, uint32_t light_count, bool apart) {
    if (!apart) {
        return {{PassKind::camera, features, path_tracing_round(features, light_count, true)}};
    }
    const FeatureMask hits = features.with(Feature::explicit_light, false);
    std::vector<Pass> passes = {
        {PassKind::implicit_paths, features, path_tracing_round(hits, light_count, true)}};
    if (features.has(Feature::explicit_light)) {
        passes.push_back({PassKind::explicit_paths, features,
                          path_tracing_round(features, light_count, false), false});
    }
    return passes;
}

}  // namespace rtrays
