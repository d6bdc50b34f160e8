// SPDX-License-Identifier: MIT
// Runs a collection of experiments one after another and makes the report.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/core/experiment.h"

namespace rtrays {

struct ReproduceOptions {
    std::string collection;         ///< "chapter4" for experiments/chapter4.json, or a path
    std::string profile = "quick";  ///< of the collection
    std::filesystem::path out;      ///< NAME.PROFILE in the working directory if empty
    std::string device;             ///< device name for `DeviceContext`
    bool dry_run = false;           ///< print the steps only
    bool quiet = false;
};

/// One experiment of a collection.
struct Step {
    std::string name;
    const Kind *kind = nullptr;
    RunOptions options;
    bool may_fail = false;  ///< whether failing cases leave the exit code unchanged

    std::filesystem::path document() const;
};

/// Reads the steps of a collection (schema/collection.schema.json), in the order of its folders and
/// then by name. Experiments without the profile are left out. Throws `Error` (bad input).
std::vector<Step> collection_steps(const ReproduceOptions &options, const std::vector<Kind> &kinds);

/// Returns the seconds between the start and the end of the run that a document records, or nothing
/// if it does not exist or records no times. With `profile`, runs of other profiles count as
/// missing.
std::optional<double> recorded_seconds(const std::filesystem::path &document,
                                       const std::string &profile = "");

/// Estimates the time left from the durations of recorded runs, which may be of another profile:
/// the ratio of the measured time to the recorded time is that of the finished steps.
class TimeLeft {
  public:
    /// Recorded seconds of every step. Steps without a record count as the mean of the others.
    /// `comparable` says that the records are of the same profile.
    TimeLeft(std::vector<std::optional<double>> recorded, bool comparable);

    /// Notes that the next step took `seconds`, or nothing if it was finished before.
    void finish(std::optional<double> seconds);

    /// Returns the estimated seconds of all other steps, or nothing without a basis.
    std::optional<double> seconds() const;

  private:
    std::vector<double> recorded_;
    bool comparable_;
    size_t finished_ = 0;
    double measured_ = 0, measured_recorded_ = 0;
};

/// Runs a collection. First compiles the kernels of all experiments without a document, one process
/// per core, because PoCL compiles on one core. Then runs the experiments, printing step, elapsed
/// time and time left, and makes the report. Repeating the command continues an interrupted call.
/// Returns `ExitCode::regression` if a check failed that may not fail. Throws the errors of the
/// experiments.
ExitCode reproduce(const ReproduceOptions &options, const std::vector<Kind> &kinds);

}  // namespace rtrays
