// SPDX-License-Identifier: MIT
// Writes a first experiment for a scene of one's own.
#pragma once

#include <filesystem>
#include <string>

namespace rtrays {

struct NewExperimentOptions {
    std::filesystem::path scene;
    std::filesystem::path file;  ///< to write; empty: NAME.json in the working directory
    bool overwrite = false;
    bool is_gate = false;
};

/// Writes an experiment that compares truncated BDPT with path tracing on a scene, both with
/// independent samples and with Sobol points; or a gate that compares path tracing with the
/// reference. Returns the text that says how to go on. Throws
/// `Error` (bad usage) if the file exists and `overwrite` is off, or if the scene cannot be read.
std::string write_new_experiment(const NewExperimentOptions &options);

}  // namespace rtrays
