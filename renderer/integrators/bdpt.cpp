// SPDX-License-Identifier: MIT
// Full bidirectional path tracing (thesis (2.69); Veach 1997, chapter 10).
//
// The passes are those of truncated bidirectional path tracing. In addition, the light pass stores
// the first N vertices of each light path (integrator.bdpt_vertices), and connect_vertices connects
// every vertex of the camera path to them: the strategies with density (5) of docs/mis-weights.md.
// Their weight is (21), and the weights of the other strategies account for them. Paths of more
// than N + 1 scattering events have the strategies and weights of the truncated kind.
#include <algorithm>

#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/light_tracing.h"
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

namespace {

/// Returns `pass` with its first stage, which starts paths, limited to the first round, and with
/// `stages` inserted before extend_path. The tail needs no such stage: it begins after the rounds
/// that connect or store vertices.
Pass with_stages(Pass pass, const std::vector<RoundStage> &stages) {
    pass.round.front().rounds = 1;
    const auto extend = std::find_if(pass.round.begin(), pass.round.end(), [](const RoundStage &s) {
        return s.stage == Stage::extend_path;
    });
    pass.round.insert(extend, stages.begin(), stages.end());
    return pass;
}

/// Returns the stages that connect the vertex of a camera path to all stored vertices.
std::vector<RoundStage> connections(uint32_t light_vertices) {
    std::vector<RoundStage> stages;
    for (uint32_t vertex = 0; vertex < light_vertices; ++vertex) {
        // In these rounds a connected path has at most `light_vertices` + 1 scattering events, the
        // number up to which all strategies sample paths (shared/integrator_settings.h).
        const uint32_t rounds = light_vertices - vertex;
        stages.push_back({Stage::connect_vertices, vertex, rounds});
        stages.push_back({Stage::intersect_any, SELECT_LIGHT, rounds});
        stages.push_back({Stage::end_shadow_rays, SELECT_LIGHT, rounds});
    }
    return stages;
}

std::vector<Pass> bdpt_passes(const PassRequest &request) {
    const FeatureMask camera = request.camera_features();
    if (!camera.has(Feature::vertex_connections) || request.light_vertices == 0) {
        PassRequest truncated = request;
        truncated.features = request.features.with(Feature::vertex_connections, false);
        return algorithms::truncated_bdpt.passes(truncated);
    }
    // Light paths come first: the camera paths of a chunk are connected to their vertices.
    std::vector<Pass> passes = {with_stages(
        light_pass(request, true), {{Stage::store_vertex, SELECT_LIGHT, request.light_vertices}})};
    const std::vector<RoundStage> all = connections(request.light_vertices);
    for (const Pass &pass : camera_passes(request)) {
        passes.push_back(
            with_stages(pass, request.separate_strategies ? std::vector<RoundStage>() : all));
    }
    if (request.separate_strategies) {
        const FeatureMask connected_only = camera.with(Feature::explicit_light, false);
        passes.push_back(
            with_stages({PassKind::connections, camera,
                         camera_round(connected_only, request.light_count, false), false},
                        all));
    }
    return passes;
}

}  // namespace

constexpr Algorithm algorithms::bdpt = [] {
    Algorithm a;
    a.name = "bdpt";
    a.computes = "both, and all connections of their vertices";
    a.sees = Sight::everything().without(PathClass::mirrored_delta_light_caustics);
    a.light_paths = LightPaths::one_per_camera_path;
    a.features = FeatureMask().with(Feature::vertex_connections);
    a.passes = bdpt_passes;
    return a;
}();

}  // namespace rtrays
