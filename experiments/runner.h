// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace rtrays {

struct RunOptions {
    std::filesystem::path experiment;
    std::string profile = "quick";
    std::filesystem::path out;  ///< empty: NAME.PROFILE in the working directory
    std::string device;         ///< as `DeviceContext` takes it
    bool dry_run = false;       ///< check everything, render nothing, print the plan
    bool compile = false;       ///< compile the kernels, render nothing
    bool quiet = false;
};

/// Runs an experiment and writes OUT/run.json and OUT/images/*.exr; returns OUT (empty where
/// nothing was to be rendered).
///
/// The same command continues a run that was stopped, and leaves a finished one as it is
/// (`Resumption`). Throws `Error`: bad input, reference missing, run failed, interrupted.
std::filesystem::path run_experiment(const RunOptions &options);

}  // namespace rtrays
