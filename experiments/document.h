// SPDX-License-Identifier: MIT
// The parts of run.json (schema/run.schema.json): what was measured, and what follows from it.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/agreement.h"
#include "experiments/metrics.h"
#include "experiments/statistics.h"
#include "renderer/base/json.h"

namespace rtrays {

constexpr int run_schema_version = 2;

/// One rung of one seed's ladder; times are cumulative from the seed's first sample.
struct Measurement {
    uint64_t spp = 0;
    double seconds_device = 0;
    double seconds_wall = 0;
    ErrorMetrics error;
};

/// The ladder of one seed.
struct Repetition {
    uint32_t seed = 0;
    std::vector<Measurement> points;
};

nlohmann::json to_json(const Interval &interval);
nlohmann::json to_json(const ErrorMetrics &metrics);
nlohmann::json to_json(const Agreement &agreement, const AgreementPolicy &policy);

/// One seed's ladder in full, and back: how a stopped run keeps what is done.
nlohmann::json to_json(const Repetition &repetition);
Repetition parse_repetition(const nlohmann::json &json);

/// "points" (medians over seeds, raw repetitions, MSE less the reference's noise, whether that
/// noise dominates), "slope" over the points before it dominates, and "slope_unbiased", the slope
/// with the noise taken off. Throws `Error` (run failed) when fewer than three points are left,
/// naming the remedy.
nlohmann::json summarise_curve(const std::vector<Repetition> &repetitions, double noise_mse);

/// The run.json of `text`. Throws `Error` (bad input) naming `source`, line and key when it does
/// not match run.schema.json; a number that is not finite was written as null and does not.
nlohmann::json parse_run(const std::string &text, const std::string &source);

}  // namespace rtrays
