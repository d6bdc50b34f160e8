// SPDX-License-Identifier: MIT
#include "renderer/integrators/algorithm.h"

#include "renderer/integrators/bdpt.h"
#include "renderer/integrators/light_tracing.h"
#include "renderer/integrators/path_tracing.h"
#include "renderer/integrators/ray_casting.h"
#include "renderer/integrators/whitted.h"

namespace rtrays {

std::vector<Pass> algorithm_passes(const std::string &algorithm, FeatureMask features,
                                   uint32_t light_count, uint32_t light_vertices, bool apart) {
    features =
        features
            .with(Feature::vertex_joins,
                  features.has(Feature::vertex_joins) && algorithm == "bdpt" && light_vertices > 0)
            .with(Feature::branches, features.has(Feature::branches) && algorithm == "whitted");
    const FeatureMask camera = features.with(Feature::from_light, false).closed();
    const FeatureMask light = features.with(Feature::from_light)
                                  .with(Feature::light_strategy, algorithm != "light_tracing")
                                  .closed();
    if (algorithm == "ray_casting") {
        return {{PassKind::camera, camera, ray_casting_round(camera, light_count)}};
    }
    if (algorithm == "whitted") {
        return {{PassKind::camera, camera, whitted_round(camera, light_count)}};
    }
    if (camera.has(Feature::vertex_joins)) {
        return bdpt_passes(camera, light, light_count, light_vertices, apart);
    }
    std::vector<Pass> passes;
    if (algorithm != "light_tracing") {
        passes = path_tracing_passes(camera, light_count, apart);
    }
    // Truncated bidirectional path tracing (thesis 2.8) has both passes. The MIS weights of each
    // pass account for the strategies of the other.
    if (algorithm != "path_tracing" && features.has(Feature::lights)) {
        passes.push_back({PassKind::light, light, light_tracing_round(light)});
    }
    for (Pass &pass : passes) {
        if (pass.features.has(Feature::scattering)) {
            pass.last_paths = {{Stage::finish_paths}, {Stage::end_round}};
        }
    }
    return passes;
}

}  // namespace rtrays
