// SPDX-License-Identifier: MIT
// Writes and reads documents (schema/results/): their common parts, and the measurements and
// results of curves.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/harness/core/agreement.h"
#include "experiments/harness/core/error_parts.h"
#include "experiments/harness/core/metrics.h"
#include "experiments/harness/core/statistics.h"
#include "renderer/base/json.h"

namespace rtrays {

/// File name of the document in the folder of a run, whatever its kind.
constexpr const char *document_name = "run.json";

constexpr int document_version = 3;

/// Measurement of one seed at one sample count. Times are cumulative from the seed's first sample.
struct Measurement {
    uint64_t spp = 0;
    double seconds_device = 0;
    double seconds_wall = 0;
    ErrorMetrics error;
    ByFirstHit mse_parts{};  ///< parts of `error.mse` by what the camera sees first
};

/// Measurements of one seed at increasing sample counts.
struct Repetition {
    uint32_t seed = 0;
    std::vector<Measurement> points;
};

nlohmann::json to_json(const Interval &interval);
nlohmann::json to_json(const ErrorMetrics &metrics);
nlohmann::json to_json(const Agreement &agreement, const AgreementPolicy &policy);

/// Writes and reads the measurements of one seed in full. An interrupted run stores finished seeds
/// in this form.
nlohmann::json to_json(const Repetition &repetition);
Repetition parse_repetition(const nlohmann::json &json);

/// Summarises a curve. "points" has, for each sample count, the medians over seeds, the raw
/// repetitions (with the parts of their MSE, whose medians would not add up), the MSE minus the
/// reference's noise, and whether that noise dominates. "slope" is the convergence slope over the
/// points before the noise dominates. "slope_unbiased" is the slope after the noise is subtracted.
/// Throws `Error` (run failed) naming the remedy if fewer than three points remain.
nlohmann::json summarise_curve(const std::vector<Repetition> &repetitions, double noise_mse);

/// Parses the text of a document and checks it against the schema of all documents and that of its
/// kind. Throws `Error` (bad input) naming `source`, line and key. JSON writes a non-finite number
/// as null, which does not fit.
nlohmann::json parse_document(const std::string &text, const std::string &source);

}  // namespace rtrays
