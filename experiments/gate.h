// SPDX-License-Identifier: MIT
// The gate: bits that may not change with scheduling, errors that may not grow, planted errors that
// must be found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/description.h"
#include "renderer/base/error.h"

namespace rtrays {

struct GateOptions {
    std::filesystem::path gate;
    std::string check = "all";  ///< bitwise | convergence | planted_errors | all
    bool update_baseline = false;
    std::string device;
    bool quiet = false;
};

/// A wrong line in a kernel: an overlay of the include resolver, never in shipped code.
struct PlantedError {
    std::string name;
    RenderSettings settings;
    std::string file, search, replacement;
    bool by_slope = false;  ///< seen in how the error falls, not in the image
};

/// A gate file (schema/gate.schema.json).
struct GateDescription : MeasuredScene {
    std::string name;
    std::string source;  ///< path of the file, for the remedy in messages
    std::filesystem::path baseline;
    struct Bitwise {
        uint64_t spp = 0, split = 0;
        std::vector<uint32_t> group_sizes, stream_capacities;
    };
    std::optional<Bitwise> bitwise;
    struct {
        std::vector<uint64_t> spp;  ///< strictly increasing
        int renders = 0, second_stage_renders = 0;
    } convergence;
    struct {
        uint64_t spp = 0;
        std::vector<PlantedError> errors;
    } planted;
};

/// Throws `Error` (bad input) naming file, key and alternatives.
GateDescription load_gate(const std::filesystem::path &path);

/// Runs the chosen checks, prints a line each on standard output; `regression` when one fails.
/// Throws `Error` (reference missing) when reference or baseline is not there.
ExitCode run_gate(const GateOptions &options);

}  // namespace rtrays
