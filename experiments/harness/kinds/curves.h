// SPDX-License-Identifier: MIT
// Runs convergence experiments.
#pragma once

#include <filesystem>
#include <string>

namespace rtrays {

struct RunOptions {
    std::filesystem::path experiment;
    std::string profile = "quick";
    std::filesystem::path out;  ///< NAME.PROFILE in the working directory if empty
    std::string device;         ///< device name for `DeviceContext`
    bool dry_run = false;       ///< check the inputs and print the plan, but render nothing
    bool compile = false;       ///< compile the kernels only
    bool quiet = false;
};

/// Runs an experiment and writes OUT/run.json and OUT/images/*.exr. Returns OUT, or an empty path
/// after a dry run or compilation.
///
/// Repeating the command continues an interrupted run and keeps a finished one (`Resumption`).
/// Throws `Error`: bad input, reference missing, run failed, interrupted.
std::filesystem::path run_experiment(const RunOptions &options);

}  // namespace rtrays
