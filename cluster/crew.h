// SPDX-License-Identifier: MIT
// Ranks that render one film together. Rank 0 hands out ranges of samples to whoever is free, and
// renders, too; at checkpoints and at the end the films of all ranks are added.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "cluster/worker.h"
#include "cluster/world.h"
#include "renderer/base/json.h"
#include "renderer/base/sample_ranges.h"

namespace rtrays::cluster {

/// What rank 0 decides.
struct Plan {
    SampleRanges missing;
    uint64_t wanted = 0;            ///< samples per pixel, with those that are not missing
    uint64_t pixels = 0;            ///< for the rate that the progress line shows
    std::optional<double> seconds;  ///< ends the render instead of the number of samples
    std::optional<double> checkpoint_interval;  ///< seconds between calls of `save`
    std::optional<double> preview_interval;     ///< seconds between calls of `preview`
    std::function<void(const FilmSums &)> save;
    std::function<void(const FilmSums &)> preview;
    bool quiet = false;
};

/// What one rank has contributed.
struct RankRecord {
    uint64_t ranges = 0, samples = 0;
    double seconds = 0;  ///< spent in `Work::render`
};

/// The end of a shared render, on rank 0.
struct Outcome {
    FilmSums film;       ///< of all ranks
    uint64_t sums = 0;   ///< how often films were added
    double seconds = 0;  ///< from the first order to the end, with sums and checkpoints
    bool interrupted = false;
    std::vector<RankRecord> ranks;
};

/// Renders the film of `plan`, which only rank 0 has, until its samples or its time end, or until a
/// signal interrupts any rank: SIGTERM, SIGINT or SIGUSR1. All ranks call it. Returns nothing
/// except on rank 0.
std::optional<Outcome> render_together(const World &world, const Work &work,
                                       const std::optional<Plan> &plan);

/// Returns the seconds of the render, the numbers of sums and of bytes that a rank has added to
/// them, and the records of all ranks with their hosts, as JSON. All ranks call it; the result is
/// null except on rank 0, which alone passes an outcome.
Json describe_job(const World &world, const std::optional<Outcome> &outcome);

}  // namespace rtrays::cluster
