// SPDX-License-Identifier: MIT
#include "renderer/integrators/ray_casting.h"

#include "renderer/integrators/path_tracing.h"

namespace rtrays {

std::vector<RoundStage> ray_casting_round(FeatureMask features, uint32_t light_count) {
    return path_tracing_round(features, light_count, true, Stage::end_paths);
}

}  // namespace rtrays
