// SPDX-License-Identifier: MIT
// Ranks that render one film together. Rank 0 hands out ranges of samples to whoever is free, and
// renders, too; at checkpoints and at the end the films of all ranks are added.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cluster/world.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"
#include "renderer/base/sample_ranges.h"

namespace rtrays::cluster {

/// The film of one rank, or of all.
struct FilmSums {
    std::vector<int64_t> words;   ///< of the exact sums; as a sum over ranks, without carries
    std::vector<double> numbers;  ///< seconds, and counts below 2^53, which add as well
    SampleRanges ranges;
};

/// What a rank can do.
struct Work {
    /// Renders samples; returns the end of those that are done, earlier if interrupted.
    std::function<uint64_t(SampleRange)> render;
    /// Returns all that this rank has rendered, and on rank 0 what was restored.
    std::function<FilmSums()> film;
};

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
    FilmSums film;  ///< of all ranks
    bool interrupted = false;
    std::vector<RankRecord> ranks;
};

/// Result of the preparation of a rank.
struct Preparation {
    std::optional<ExitCode> ended;  ///< the program ends, after --help for instance
    std::string error;              ///< the reason, if an error ends it
    /// Names and values that must be equal on all ranks, the most important first.
    std::vector<std::pair<std::string, std::string>> identity;
};

/// Calls `prepare` on the first rank of each node, then on the others, which find its kernels in
/// the cache. Turns an `Error` into a preparation.
Preparation prepare_in_turn(const World &world, const std::function<Preparation()> &prepare);

/// Compares the preparations of all ranks. Returns the exit code if the program ends: because all
/// ranks end, because of errors, or because ranks differ. Rank 0 prints the reason, which names the
/// ranks and what differs. All ranks call it.
std::optional<ExitCode> agree(const World &world, const Preparation &preparation);

/// Renders the film of `plan`, which only rank 0 has, until its samples or its time end, or until a
/// signal interrupts any rank: SIGTERM, SIGINT or SIGUSR1. All ranks call it. Returns nothing
/// except on rank 0.
std::optional<Outcome> render_together(const World &world, const Work &work,
                                       const std::optional<Plan> &plan);

/// Returns the records of all ranks as JSON, with their hosts. All ranks call it; the result is
/// null except on rank 0, which alone passes an outcome.
Json describe_ranks(const World &world, const std::optional<Outcome> &outcome);

}  // namespace rtrays::cluster
