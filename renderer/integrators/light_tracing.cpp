// SPDX-License-Identifier: MIT
#include "renderer/integrators/light_tracing.h"

namespace rtrays {

std::vector<RoundStage> light_tracing_round(FeatureMask features) {
    std::vector<RoundStage> round = {{"generate_light_paths"}, {"begin_round"}};
    const auto connect = [&](const char *stage) {
        round.push_back({stage});
        round.push_back({"splat_unblocked"});
        round.push_back({"end_shadow_rays"});
    };
    const bool emitters = features.has(Feature::area_lights) || features.has(Feature::shape_lights);
    if (emitters &&
        (features.has(Feature::light_emitters) || !features.has(Feature::light_strategy))) {
        connect("connect_emitter");  // emitters seen directly
    }
    if (features.has(Feature::scattering)) {
        round.push_back({"intersect_nearest"});
        connect("connect_camera");
    }
    round.push_back({"extend_path"});
    round.push_back({"end_round"});
    return round;
}

}  // namespace rtrays
