// SPDX-License-Identifier: MIT
#include "renderer/integrators/count_rays.h"

namespace rtrays {

std::vector<Pass> counting_passes(std::vector<Pass> passes) {
    for (Pass &pass : passes) {
        std::vector<RoundStage> round;
        for (const RoundStage &stage : pass.round) {
            if (stage.stage == Stage::begin_round) {
                round.push_back({Stage::count_nearest_rays});
            } else if (stage.stage == Stage::end_shadow_rays) {
                round.push_back(stage);
                round.back().stage = Stage::count_shadow_rays;
            }
            round.push_back(stage);
        }
        pass.round = round;
        pass.tail.clear();
    }
    return passes;
}

}  // namespace rtrays
