// SPDX-License-Identifier: MIT
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

std::vector<RoundStage> path_tracing_round(FeatureMask features, uint32_t light_count,
                                           bool adds_hits, const std::string &secondary) {
    std::vector<RoundStage> round = {
        {"generate_camera_rays"}, {"begin_round"}, {"intersect_nearest"}};
    const bool emitters = features.has(Feature::area_lights) ||
                          features.has(Feature::shape_lights) ||
                          features.has(Feature::infinite_lights);
    if ((emitters && adds_hits) || features.has(Feature::light_strategy)) {
        // Adds implicit paths and emitters seen directly, and sets the ratio R_0 of light/mis.h.
        round.push_back({"evaluate_emission"});
    }
    if (features.has(Feature::explicit_light)) {
        const bool independent = features.has(Feature::independent_lights);
        for (uint32_t light = 0; light < (independent ? light_count : 1u); ++light) {
            round.push_back({"sample_light", independent ? light : SELECT_LIGHT});
            round.push_back({"intersect_any"});
            round.push_back({"end_shadow_rays"});
        }
    }
    round.push_back({secondary});
    round.push_back({"end_round"});
    return round;
}

std::vector<Pass> path_tracing_passes(FeatureMask features, uint32_t light_count, bool apart) {
    if (!apart) {
        return {{"camera", features, path_tracing_round(features, light_count, true)}};
    }
    const FeatureMask hits = features.with(Feature::explicit_light, false);
    std::vector<Pass> passes = {
        {"implicit", features, path_tracing_round(hits, light_count, true)}};
    if (features.has(Feature::explicit_light)) {
        passes.push_back(
            {"explicit", features, path_tracing_round(features, light_count, false), false});
    }
    return passes;
}

}  // namespace rtrays
