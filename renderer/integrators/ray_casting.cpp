// SPDX-License-Identifier: MIT
// Ray casting: path tracing without secondary rays (thesis 3.3.1).
#include "renderer/integrators/ray_casting.h"

#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

namespace {

std::vector<Pass> ray_casting_passes(const PassRequest &request) {
    const FeatureMask features = request.camera_features();
    return {{PassKind::camera, features, ray_casting_round(features, request.light_count)}};
}

}  // namespace

std::vector<RoundStage> ray_casting_round(FeatureMask features, uint32_t light_count) {
    return camera_round(features, light_count, true, Stage::retire_paths);
}

constexpr Algorithm algorithms::ray_casting = [] {
    Algorithm a;
    a.name = "ray_casting";
    a.computes = "the first hit, lit directly";
    a.sees = Sight()
                 .with(PathClass::area_lights)
                 .with(PathClass::infinite_lights)
                 .with(PathClass::direct_light)
                 .with(PathClass::infinite_light_outside)
                 .with(PathClass::nearly_specular, Visibility::in_part);
    a.is_random = false;
    a.fixed_depth = 1;
    a.passes = ray_casting_passes;
    return a;
}();

}  // namespace rtrays
