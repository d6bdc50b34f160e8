// SPDX-License-Identifier: MIT
// Whitted's ray tracing (thesis 2.7.6, 3.3.1): ray casting with all ideal reflections and
// refractions as secondary rays. The paths found are E S* L and E S* D L.
#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/path_tracing.h"
#include "renderer/integrators/ray_casting.h"

namespace rtrays {

namespace {

std::vector<Pass> whitted_passes(const PassRequest &request) {
    const FeatureMask features = request.camera_features();
    // If the scene has no mirror or smooth glass, no path continues beyond its first hit.
    return {{PassKind::camera, features,
             features.has(Feature::delta)
                 ? camera_round(features, request.light_count, true, Stage::follow_branches)
                 : ray_casting_round(features, request.light_count)}};
}

}  // namespace

constexpr Algorithm algorithms::whitted = [] {
    Algorithm a;
    a.name = "whitted";
    a.computes = "direct light, seen through all ideal mirrors and glass";
    a.sees = Sight()
                 .with(PathClass::area_lights)
                 .with(PathClass::infinite_lights)
                 .with(PathClass::direct_light)
                 .with(PathClass::infinite_light_outside)
                 .with(PathClass::mirrors, Visibility::in_part)
                 .with(PathClass::nearly_specular, Visibility::in_part);
    a.is_random = false;
    a.default_depth = 8;
    a.features = FeatureMask().with(Feature::branches);
    a.passes = whitted_passes;
    return a;
}();

}  // namespace rtrays
