// SPDX-License-Identifier: MIT
#include "renderer/integrators/whitted.h"

#include "renderer/integrators/path_tracing.h"
#include "renderer/integrators/ray_casting.h"

namespace rtrays {

std::vector<RoundStage> whitted_round(FeatureMask features, uint32_t light_count) {
    // If the scene has no mirror or smooth glass, no path continues beyond its first hit.
    return features.has(Feature::delta)
               ? path_tracing_round(features, light_count, true, Stage::follow_branches)
               : ray_casting_round(features, light_count);
}

}  // namespace rtrays
