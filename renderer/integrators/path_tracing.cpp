// SPDX-License-Identifier: MIT
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

std::vector<std::string> path_tracing_round(FeatureMask features) {
    std::vector<std::string> round = {"generate_camera_rays", "begin_round", "intersect_nearest"};
    if (features.has(Feature::lights)) {
        round.emplace_back("evaluate_emission");  // implicit paths, and emitters seen directly
    }
    if (features.has(Feature::explicit_light)) {
        round.emplace_back("sample_light");
        round.emplace_back("intersect_any");
    }
    round.emplace_back("extend_path");
    round.emplace_back("end_round");
    return round;
}

}  // namespace rtrays
