// SPDX-License-Identifier: MIT
// Passes of an algorithm, and their rounds of stages.
#pragma once

#include <vector>

#include "renderer/compile/pass_kind.h"
#include "renderer/compile/stage_table.h"
#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// A stage in a round.
struct RoundStage {
    Stage stage;
    /// Index of the light that sample_light connects to (SELECT_LIGHT: one is selected at random),
    /// or of the light vertex that connect_vertices connects to.
    uint32_t index = SELECT_LIGHT;
    /// The stage is launched in the first `rounds` rounds of a chunk of work, 0: in every round.
    uint32_t rounds = 0;
    /// The stage serves connections of emitters to the camera, and is not launched if the camera
    /// sees none directly.
    bool shows_emitters = false;
};

/// A pass traces paths from one end, the camera or the lights. Each round advances every path in
/// flight by one vertex, and rounds repeat until all paths have ended. An algorithm's image is the
/// sum over its passes.
///
/// Passes are independent of each other unless they have `vertex_connections`. With that feature
/// the work is cut into chunks of as many paths as the streams hold, and the passes follow one
/// another within each chunk. All paths of a chunk start in its first round, so that a path's depth
/// equals the round's index.
struct Pass {
    PassKind kind;
    /// Features of the pass's kernels and path states.
    FeatureMask features;
    /// Stages in order, without those that the features do not require.
    std::vector<RoundStage> round;
    /// Whether this pass adds the emission that its paths hit; otherwise another pass adds it.
    bool adds_hits = true;
    /// Whether streams of paths connect the pass's stages; otherwise its only stage runs once and
    /// traces all paths to their ends.
    bool streams = true;
    /// Round for the tail of a batch, its last few paths: it advances each of them by many
    /// vertices. Empty if they use the normal round to the end.
    std::vector<RoundStage> tail = {};
};

/// Facts about the scene and the settings that decide the passes of an algorithm.
struct PassRequest {
    /// Features of scene and settings.
    FeatureMask features;
    /// Number of lights, each of which is sampled separately if `independent_lights` is on.
    uint32_t light_count = 1;
    /// Whether light paths are traced, if the algorithm has any.
    bool traces_light_paths = true;
    /// Number of vertices stored per light path, if the algorithm connects them to camera paths.
    uint32_t light_vertices = 0;
    /// Whether paths from the camera are traced once for each strategy that ends them, weighted
    /// against all strategies. Each pass's image is then the contribution of its strategy (thesis,
    /// figures 4.8 to 4.17).
    bool separate_strategies = false;

    /// Returns the features of passes that trace paths from the camera.
    FeatureMask camera_features() const {
        return features.with(Feature::from_light, false).closed();
    }
};

/// Returns `pass` with the stages for the tail of a batch, if its paths may become long.
inline Pass with_tail(Pass pass) {
    if (pass.features.has(Feature::scattering)) {
        pass.tail = {{Stage::run_tail}, {Stage::end_round}};
    }
    return pass;
}

}  // namespace rtrays
