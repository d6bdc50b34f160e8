// SPDX-License-Identifier: MIT
// Regression gate: images that must not change with scheduling, errors that must not grow, and
// planted errors that must be found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/core/description.h"
#include "renderer/base/error.h"

namespace rtrays {

struct GateOptions {
    std::filesystem::path gate;
    std::string check = "all";  ///< bitwise | convergence | planted_errors | all
    bool update_baseline = false;
    std::string device;
    bool quiet = false;
};

/// A deliberate error in one line of a kernel. It is applied as an overlay of the include resolver
/// and never appears in shipped code.
struct PlantedError {
    std::string name;
    RenderSettings settings;
    std::string file, search, replacement;
    bool by_slope = false;  ///< found by the convergence slope, not by the image
};

/// A gate file (schema/gate.schema.json).
struct GateDescription : MeasuredScene {
    std::string name;
    std::string source;  ///< path of the gate file, for the commands in messages
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

/// Reads and checks a gate file. Throws `Error` (bad input) naming file, key and alternatives.
GateDescription load_gate(const std::filesystem::path &path);

/// Runs the chosen checks. Prints one line for each and a summary line on standard output. Returns
/// `ExitCode::regression` if one fails. Throws `Error` (reference missing) if the reference or the
/// baseline does not exist, and `Error` (bad input) before rendering if an error cannot be planted.
ExitCode run_gate(const GateOptions &options);

}  // namespace rtrays
