// SPDX-License-Identifier: MIT
// Path tracing (thesis 2.7): paths from the camera with two strategies.
//
// Implicit: the path hits an emitter; evaluate_emission adds its emission. Explicit: a point on a
// light is sampled and connected to the path's vertex (next-event estimation); sample_light adds
// its light. With integrator.strategies=mis both have the weights (8) of docs/mis-weights.md.
#include "renderer/integrators/path_tracing.h"

#include "renderer/integrators/algorithm.h"

namespace rtrays {

std::vector<RoundStage> camera_round(FeatureMask features, uint32_t light_count, bool adds_hits,
                                     Stage secondary) {
    std::vector<RoundStage> round = {
        {Stage::generate_camera_rays}, {Stage::begin_round}, {Stage::intersect_nearest}};
    const bool emitters = features.has(Feature::area_lights) ||
                          features.has(Feature::shape_lights) ||
                          features.has(Feature::infinite_lights);
    if ((emitters && adds_hits) || features.has(Feature::light_strategy)) {
        // Adds implicit paths and emitters seen directly, and sets the ratio R_0, equation (11) of
        // docs/mis-weights.md.
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

std::vector<Pass> camera_passes(const PassRequest &request) {
    const FeatureMask features = request.camera_features();
    const auto pass = [&](PassKind kind, FeatureMask of_round, bool adds_hits) {
        return with_tail(
            {kind, features, camera_round(of_round, request.light_count, adds_hits), adds_hits});
    };
    if (!request.separate_strategies) {
        return {pass(PassKind::camera, features, true)};
    }
    std::vector<Pass> passes = {
        pass(PassKind::implicit_paths, features.with(Feature::explicit_light, false), true)};
    if (features.has(Feature::explicit_light)) {
        passes.push_back(pass(PassKind::explicit_paths, features, false));
    }
    return passes;
}

constexpr Algorithm algorithms::path_tracing = [] {
    Algorithm a;
    a.name = "path_tracing";
    a.computes = "all light that camera paths find";
    a.sees = Sight::everything()
                 .without(PathClass::delta_light_caustics)
                 .without(PathClass::mirrored_delta_light_caustics)
                 .without(PathClass::mirrored_light_of_delta_light_caustics);
    a.may_be_implicit = a.may_be_explicit = true;
    a.stops_pixels = true;
    a.has_megakernel = true;
    a.passes = camera_passes;
    return a;
}();

}  // namespace rtrays
