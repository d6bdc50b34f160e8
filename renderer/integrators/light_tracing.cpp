// SPDX-License-Identifier: MIT
#include "renderer/integrators/light_tracing.h"

namespace rtrays {

std::vector<RoundStage> light_tracing_round(FeatureMask features) {
    std::vector<RoundStage> round = {{Stage::generate_light_paths}, {Stage::begin_round}};
    const auto connect = [&](Stage stage) {
        round.push_back({stage});
        round.push_back({Stage::splat_unblocked});
        round.push_back({Stage::end_shadow_rays});
    };
    const bool emitters = features.has(Feature::area_lights) || features.has(Feature::shape_lights);
    if (emitters &&
        (features.has(Feature::light_emitters) || !features.has(Feature::light_strategy))) {
        connect(Stage::connect_emitter);  // emitters seen directly
    }
    if (features.has(Feature::scattering)) {
        round.push_back({Stage::intersect_nearest});
        connect(Stage::connect_camera);
    }
    round.push_back({Stage::extend_path});
    round.push_back({Stage::end_round});
    return round;
}

}  // namespace rtrays
