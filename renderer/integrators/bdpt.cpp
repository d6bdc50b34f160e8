// SPDX-License-Identifier: MIT
#include "renderer/integrators/bdpt.h"

#include <algorithm>

#include "renderer/integrators/light_tracing.h"
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

namespace {

/// Returns `round` with its first stage, which starts paths, limited to the first round, and with
/// `stages` inserted before extend_path.
std::vector<RoundStage> with_stages(std::vector<RoundStage> round,
                                    const std::vector<RoundStage> &stages) {
    round.front().rounds = 1;
    const auto extend = std::find_if(round.begin(), round.end(), [](const RoundStage &s) {
        return s.stage == Stage::extend_path;
    });
    round.insert(extend, stages.begin(), stages.end());
    return round;
}

}  // namespace

std::vector<Pass> bdpt_passes(FeatureMask camera, FeatureMask light, uint32_t light_count,
                              uint32_t light_vertices, bool apart) {
    std::vector<RoundStage> joins;
    for (uint32_t vertex = 0; vertex < light_vertices; ++vertex) {
        // In these rounds a connected path has at most `light_vertices` + 1 scattering events, the
        // number up to which all strategies sample paths (shared/integrator_settings.h).
        const uint32_t rounds = light_vertices - vertex;
        joins.push_back({Stage::connect_vertices, vertex, rounds});
        joins.push_back({Stage::intersect_any, SELECT_LIGHT, rounds});
        joins.push_back({Stage::end_shadow_rays, SELECT_LIGHT, rounds});
    }
    std::vector<Pass> passes = path_tracing_passes(camera, light_count, apart);
    for (Pass &pass : passes) {
        pass.round = with_stages(pass.round, apart ? std::vector<RoundStage>() : joins);
    }
    if (apart) {
        const FeatureMask joined_only = camera.with(Feature::explicit_light, false);
        passes.push_back({PassKind::connections, camera,
                          with_stages(path_tracing_round(joined_only, light_count, false), joins),
                          false});
    }
    passes.insert(passes.begin(),
                  {PassKind::light, light,
                   with_stages(light_tracing_round(light),
                               {{Stage::store_vertex, SELECT_LIGHT, light_vertices}})});
    return passes;
}

}  // namespace rtrays
