// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// A stage in a round.
struct RoundStage {
    std::string name;
    uint32_t chosen = SELECT_LIGHT;  ///< light of sample_light, vertex of connect_vertices
    uint32_t rounds = 0;  ///< launched in the first so many rounds of a chunk of work; 0: in all
};

/// Paths from one end, round after round until all have ended; in every round each of them advances
/// by one vertex. The image is the sum over the passes of an algorithm. They need nothing of each
/// other, unless they have `vertex_joins`: then the work is cut into chunks of as many paths as the
/// streams hold, in each of which one pass follows on the other. All paths of a chunk start in its
/// first round, so that round number and depth are the same.
struct Pass {
    std::string name;  ///< "camera" or "light"; of one strategy: "implicit", "explicit", "joins"
    FeatureMask features;  ///< of its kernels and path states
    std::vector<RoundStage>
        round;              ///< in order; stages that the features do not call for are absent
    bool adds_hits = true;  ///< what its paths hit counts; else another pass sees to that
    bool streams =
        true;  ///< of paths between its stages; else it has one, which runs once and ends all paths
    /// The round of the last few paths, which takes each of them far; empty where they go on as
    /// before.
    std::vector<RoundStage> last_paths = {};
};

/// The passes of an algorithm (settings.h names them) for a scene and settings with these features.
/// `light_count`: each light is sampled in turn where the features say so. `light_vertices`: as
/// many are kept of light paths where the algorithm joins them. `apart`: the paths from the camera
/// are traced once for each strategy that ends them, with the weights of them all: the images of
/// the passes are what each contributes (thesis, figures 4.8 to 4.17).
std::vector<Pass> algorithm_passes(const std::string &algorithm, FeatureMask features,
                                   uint32_t light_count, uint32_t light_vertices,
                                   bool apart = false);

}  // namespace rtrays
