// SPDX-License-Identifier: MIT
#include "renderer/integrators/algorithm.h"

#include "renderer/integrators/light_tracing.h"
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

std::vector<Pass> algorithm_passes(const std::string &algorithm, FeatureMask features, uint32_t light_count) {
    std::vector<Pass> passes;
    if (algorithm != "light_tracing") {
        const FeatureMask camera = features.with(Feature::from_light, false).closed();
        passes.push_back({"camera", camera, path_tracing_round(camera, light_count)});
    }
    // Truncated bidirectional path tracing (thesis 2.8) is both: their weights know of each other.
    if (algorithm != "path_tracing" && features.has(Feature::lights)) {
        const FeatureMask light = features.with(Feature::from_light)
                                      .with(Feature::light_strategy, algorithm == "truncated_bdpt")
                                      .closed();
        passes.push_back({"light", light, light_tracing_round(light)});
    }
    return passes;
}

}  // namespace rtrays
