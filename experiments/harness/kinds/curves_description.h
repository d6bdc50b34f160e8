// SPDX-License-Identifier: MIT
// Reads files of the kind "curves" (schema/curves.schema.json).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "experiments/harness/core/description.h"

namespace rtrays {

/// Number of batches into which the samples of a seed are divided. Eight seeds give the 32 batches
/// that a variance estimate needs.
constexpr uint64_t batches_per_seed = 4;

struct ThroughputDescription {
    CurveDescription curve;  ///< the last one of this renderer
    int repetitions = 0;
    uint64_t spp = 0;  ///< samples per pixel of one repetition
};

/// An experiment of curves, with one of its profiles.
struct CurvesDescription : MeasuredScene {
    std::string name, title, thesis, claim;
    double expected_slope = -0.5, slope_tolerance = 0.03;
    /// Gain over path tracing that the thesis states, {"algorithm", "samples", "time"}, or null.
    Json expected_gain;
    // The remaining members belong to the chosen profile.
    std::string profile;
    std::optional<ThroughputDescription> throughput;
    Json settings;       ///< {"integrator.beta": 2, ...}: applied to all curves
    std::string source;  ///< text of the file with the chosen profile alone
};

/// Reads a profile of a file that fits its schema. Throws `Error` (bad input) naming the file, the
/// key and the alternatives.
CurvesDescription read_curves(const DescriptionFile &file, const std::string &profile);

}  // namespace rtrays
