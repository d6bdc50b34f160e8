// SPDX-License-Identifier: MIT
// The kind "gate": images that must not change with scheduling, errors that must not grow, and
// planted errors that must be found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/core/experiment.h"
#include "experiments/harness/kinds/planted_error.h"

namespace rtrays {

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
    struct Convergence {
        std::vector<uint64_t> spp;  ///< strictly increasing
        int renders = 0, second_stage_renders = 0;
    };
    std::optional<Convergence> convergence;
    struct AgreementCheck {
        uint64_t spp = 0;
        std::vector<PlantedError> planted_errors;
    };
    std::optional<AgreementCheck> agreement;
};

/// Reads a gate file that fits its schema. Throws `Error` (bad input) naming file, key and
/// alternatives.
GateDescription read_gate(const DescriptionFile &file);

/// Makes an experiment that runs the chosen checks, or measures the baseline. It prints one line
/// for each check. `RunOptions::save` is a folder for "checks.json", "checks.xml" (JUnit) and the
/// images of failed checks. Throws `Error` (reference missing) if the reference or
/// the baseline does not exist, and `Error` (bad input) if an error cannot be planted.
std::unique_ptr<Experiment> make_gate(const DescriptionFile &file, const RunOptions &options);

}  // namespace rtrays
