// SPDX-License-Identifier: MIT
// Renders one curve. Each seed is rendered to a ladder of increasing sample counts; an interrupted
// curve is resumed seed by seed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/harness/core/document.h"
#include "experiments/harness/core/error_parts.h"
#include "experiments/harness/kinds/curve_source.h"
#include "experiments/harness/kinds/curves_description.h"

namespace rtrays {

/// Inputs of a curve's ladders.
struct LadderTask {
    std::string id;  ///< of the curve
    std::function<std::unique_ptr<CurveSource>()> make_source;
    /// Whether an image of a seed consists of the samples of the one before and of others that are
    /// independent of them. Other renderers restart, and Sobol points depend on each other.
    bool has_batches = true;
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
    /// the image of each seed if it has no batches.
    std::vector<Image> batches;
    std::vector<Image> early_images;  ///< images of the first seed at `LadderTask::early_images`
    nlohmann::json description;       ///< `CurveSource::description` after the last seed
};

/// Renders the ladders of all seeds. Finished seeds are read from `partial`; the others are
/// rendered and stored there. Throws `Error` (interrupted) on SIGINT and SIGTERM.
LadderResult render_ladders(const LadderTask &task);

/// Renders as many batches as the ladders have, each with twice the samples. They use seeds that no
/// ladder uses.
std::vector<Image> render_fresh_batches(const LadderTask &task);

}  // namespace rtrays
