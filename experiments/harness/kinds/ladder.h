// SPDX-License-Identifier: MIT
// Renders one curve. Each seed is rendered to a ladder of increasing sample counts in one session;
// an interrupted curve is resumed seed by seed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/error_parts.h"
#include "experiments/harness/core/rendering.h"
#include "experiments/harness/kinds/curves_description.h"
#include "renderer/device/context.h"
#include "renderer/scene/scene.h"
#include "renderer/session/shared_scenes.h"

namespace rtrays {

/// Inputs of a curve's ladders.
struct LadderTask {
    SharedScenes &scenes;
    RenderSettings settings;    ///< including the size
    std::vector<uint64_t> spp;  ///< increasing; the last is a multiple of `batches_per_seed`
    uint32_t seeds = 0;
    std::vector<uint64_t> early_images;  ///< sample counts at which the first seed's image is kept
    const Image &reference;
    const FirstHits &first_hits;            ///< classes of the pixels
    std::filesystem::path partial;          ///< folder of finished seeds
    std::function<void(uint64_t)> advance;  ///< called with the newly finished samples per pixel
};

struct LadderResult {
    std::vector<Repetition> repetitions;
    std::vector<Image> images;  ///< image of each seed at the largest sample count
    /// R, G, B of independent samples: `batches_per_seed` batches of equal size from each seed, or
    /// with Sobol points, whose batches of one seed are not independent, the image of each seed.
    std::vector<Image> batches;
    std::vector<Image> early_images;  ///< images of the first seed at `LadderTask::early_images`
    nlohmann::json cost;              ///< {"compile_seconds", "bvh_seconds", "render_report"}
};

/// Renders the ladders of all seeds. Finished seeds are read from `partial`; the others are
/// rendered and stored there. Throws `Error` (interrupted) on SIGINT and SIGTERM.
LadderResult render_ladders(const LadderTask &task);

/// Renders as many batches as the ladders have, each with twice the samples. They use a seed that
/// no ladder uses.
std::vector<Image> render_fresh_batches(const LadderTask &task);

}  // namespace rtrays
