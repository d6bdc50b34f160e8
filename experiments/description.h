// SPDX-License-Identifier: MIT
// What an experiment file asks for (schema/experiment.schema.json).
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/statistics.h"
#include "renderer/base/json.h"
#include "renderer/pipeline/settings.h"

namespace rtrays {

/// One curve: an algorithm with its settings.
struct CurveDescription {
    RenderSettings settings;  ///< size and seed are set by the runner

    /// "path_tracing.mis": names the curve's files.
    std::string id() const { return settings.algorithm + "." + settings.strategies; }
};

struct ThroughputDescription {
    int repetitions = 0;
    uint64_t spp = 0;  ///< of one repetition
};

struct ExperimentDescription {
    std::string name, title, thesis, claim;
    double expected_slope = 0, slope_tolerance = 0;
    std::filesystem::path scene;             ///< resolved against the experiment file
    std::filesystem::path reference_folder;  ///< likewise
    std::string reference_engine;
    std::vector<CurveDescription> curves;
    // of the chosen profile
    std::string profile;
    int width = 0, height = 0;
    std::vector<uint64_t> spp;  ///< strictly increasing
    int seeds = 0;              ///< seeds 1 .. seeds
    ThroughputDescription throughput;
    Json source;  ///< the file as written
};

/// Reads and checks an experiment; `profile` is "quick", "full" or "ci". Throws `Error` (bad input) naming
/// file, key and alternatives.
ExperimentDescription load_experiment(const std::filesystem::path &path, const std::string &profile);

/// Render settings from {"algorithm", "settings": {"integrator.beta": 2, ...}} with the names of `--set`.
/// What is not named keeps the renderer's default. Throws `Error` (bad usage) naming the alternatives.
RenderSettings parse_render_settings(const Json &curve);

}  // namespace rtrays
