// SPDX-License-Identifier: MIT
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

std::vector<RoundStage> path_tracing_round(FeatureMask features, uint32_t light_count) {
    std::vector<RoundStage> round = {{"generate_camera_rays"}, {"begin_round"}, {"intersect_nearest"}};
    const bool emitters = features.has(Feature::area_lights) || features.has(Feature::shape_lights) ||
                          features.has(Feature::infinite_lights);
    if (emitters || features.has(Feature::light_strategy)) {
        round.push_back({"evaluate_emission"});  // implicit paths, and emitters seen directly; the ratio R_0
    }
    if (features.has(Feature::explicit_light)) {
        const bool independent = features.has(Feature::independent_lights);
        for (uint32_t light = 0; light < (independent ? light_count : 1u); ++light) {
            round.push_back({"sample_light", independent ? light : SELECT_LIGHT});
            round.push_back({"intersect_any"});
            round.push_back({"end_shadow_rays"});
        }
    }
    round.push_back({"extend_path"});
    round.push_back({"end_round"});
    return round;
}

}  // namespace rtrays
