// SPDX-License-Identifier: MIT
// Light tracing: paths from the lights, connected to the camera (thesis 2.8).
//
// The only strategy samples a point on the lens and connects it to each vertex of a light path. Its
// contribution is equation (9) of docs/mis-weights.md, with weight 1.
#include "renderer/integrators/light_tracing.h"

#include "renderer/integrators/algorithm.h"

namespace rtrays {

namespace {

std::vector<RoundStage> light_round(FeatureMask features) {
    std::vector<RoundStage> round = {{Stage::generate_light_paths}, {Stage::begin_round}};
    const auto splat = [&](bool emitters) {
        round.push_back({Stage::splat_unblocked});
        round.back().shows_emitters = emitters;
        round.push_back({Stage::end_shadow_rays});
        round.back().shows_emitters = emitters;
    };
    const bool emitters = features.has(Feature::area_lights) || features.has(Feature::shape_lights);
    if (emitters &&
        (features.has(Feature::light_emitters) || !features.has(Feature::light_strategy))) {
        splat(/*emitters=*/true);  // connected by generate_light_paths
    }
    if (features.has(Feature::scattering)) {
        round.push_back({Stage::intersect_nearest});
        round.push_back({Stage::connect_camera});
        splat(/*emitters=*/false);
    }
    round.push_back({Stage::extend_path});
    round.push_back({Stage::end_round});
    return round;
}

std::vector<Pass> light_tracing_passes(const PassRequest &request) {
    if (!request.features.has(Feature::lights)) {
        return {};
    }
    return {light_pass(request, false)};
}

}  // namespace

Pass light_pass(const PassRequest &request, bool weighted) {
    const FeatureMask features =
        request.features.with(Feature::from_light).with(Feature::light_strategy, weighted).closed();
    return with_tail({PassKind::light, features, light_round(features)});
}

constexpr Algorithm algorithms::light_tracing = [] {
    Algorithm a;
    a.name = "light_tracing";
    a.computes = "all light that light paths bring to the camera";
    // A vertex of a mirror or of smooth glass cannot be connected to the camera, and its connection
    // is unlikely to matter at a nearly specular one. Light from infinity starts on a disc that
    // covers the bounding sphere of the scene.
    a.sees = Sight::everything()
                 .without(PathClass::infinite_lights)
                 .without(PathClass::infinite_light_outside)
                 .without(PathClass::mirrors)
                 .without(PathClass::mirrored_caustics)
                 .without(PathClass::mirrored_delta_light_caustics)
                 .without(PathClass::mirrored_light_of_delta_light_caustics)
                 .with(PathClass::nearly_specular, Visibility::in_practice_not);
    a.traces_camera_paths = false;
    a.light_paths = LightPaths::at_least_one;
    a.passes = light_tracing_passes;
    return a;
}();

}  // namespace rtrays
