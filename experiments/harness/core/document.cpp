// SPDX-License-Identifier: MIT
#include "experiments/harness/core/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "embedded/experiment_schemas.h"
#include "renderer/base/error.h"

namespace rtrays {

using nlohmann::json;

namespace {

constexpr double slope_confidence = 0.95;

/// Writes errors and times without `spp`.
json to_json(const Measurement &measurement) {
    json numbers = to_json(measurement.error);
    numbers["seconds_device"] = measurement.seconds_device;
    numbers["seconds_wall"] = measurement.seconds_wall;
    numbers["mse_parts"] = rtrays::to_json(measurement.mse_parts);
    return numbers;
}

/// Summarises one sample count: the median of each value over the seeds, and the raw repetitions.
json summarise_point(const std::vector<Repetition> &repetitions, size_t point, double noise_mse) {
    json raw = json::array();
    std::map<std::string, std::vector<double>> values;
    for (const auto &repetition : repetitions) {
        json entry = to_json(repetition.points[point]);
        for (const auto &[key, number] : entry.items()) {
            if (number.is_number()) {
                values[key].push_back(number);
            }
        }
        entry["seed"] = repetition.seed;
        raw.push_back(entry);
    }
    json summary = {{"spp", repetitions.front().points[point].spp}, {"repetitions", raw}};
    for (const auto &[key, numbers] : values) {
        summary[key] = median(numbers);
    }
    const double mse = summary.at("mse");
    summary["mse_unbiased"] = unbiased_mse(mse, noise_mse);
    summary["noise_dominates"] = noise_dominates(mse, noise_mse);
    return summary;
}

/// Computes the slope over the first `count` sample counts. `noise_mse` is subtracted from the MSE;
/// 0 keeps it as measured.
json slope_of(const std::vector<Repetition> &repetitions, size_t count, double noise_mse) {
    std::vector<double> spp;
    std::vector<std::vector<double>> errors;
    for (size_t p = 0; p < count; ++p) {
        spp.push_back(static_cast<double>(repetitions.front().points[p].spp));
    }
    for (const auto &repetition : repetitions) {
        errors.emplace_back();
        for (size_t p = 0; p < count; ++p) {
            errors.back().push_back(
                std::sqrt(unbiased_mse(repetition.points[p].error.mse, noise_mse)));
        }
    }
    json slope = to_json(convergence_slope(spp, errors, slope_confidence));
    slope["confidence"] = slope_confidence;
    slope["spp"] = {repetitions.front().points.front().spp,
                    repetitions.front().points[count - 1].spp};
    return slope;
}

}  // namespace

json to_json(const Interval &interval) {
    return {{"value", interval.value}, {"low", interval.low}, {"high", interval.high}};
}

json to_json(const ErrorMetrics &metrics) {
    json document;
    for (const auto &[key, field] : metric_keys) {
        document[key] = metrics.*field;
    }
    return document;
}

json to_json(const Agreement &agreement, const AgreementPolicy &policy) {
    json difference = to_json(agreement.relative_difference);
    difference["confidence"] = policy.confidence;
    difference["limit"] = policy.equivalence_limit;
    return {{"block_size", policy.block_size},
            {"alpha", policy.alpha},
            {"tests", agreement.tests},
            {"rejected", agreement.rejected},
            {"unconfirmed", agreement.unconfirmed},
            {"agrees", agreement.agrees()},
            {"largest_z", agreement.largest_z},
            {"largest_z_at", agreement.largest_z_at},
            {"smallest_adjusted_p", agreement.smallest_adjusted_p},
            {"relative_difference", difference},
            {"equivalence", to_string(agreement.equivalence)}};
}

json to_json(const Repetition &repetition) {
    json points = json::array();
    for (const auto &measurement : repetition.points) {
        json point = to_json(measurement);
        point["spp"] = measurement.spp;
        points.push_back(point);
    }
    return {{"seed", repetition.seed}, {"points", points}};
}

Repetition parse_repetition(const json &document) {
    Repetition repetition;
    document.at("seed").get_to(repetition.seed);
    for (const json &point : document.at("points")) {
        Measurement measurement;
        point.at("spp").get_to(measurement.spp);
        point.at("seconds_device").get_to(measurement.seconds_device);
        point.at("seconds_wall").get_to(measurement.seconds_wall);
        for (const auto &[key, field] : metric_keys) {
            point.at(key).get_to(measurement.error.*field);
        }
        measurement.mse_parts = parse_by_first_hit(point.at("mse_parts"));
        repetition.points.push_back(measurement);
    }
    return repetition;
}

json summarise_curve(const std::vector<Repetition> &repetitions, double noise_mse) {
    json points = json::array();
    for (size_t p = 0; p < repetitions.at(0).points.size(); ++p) {
        points.push_back(summarise_point(repetitions, p, noise_mse));
    }
    const auto first_noisy = std::find_if(points.begin(), points.end(), [](const json &point) {
        return point.at("noise_dominates").get<bool>();
    });
    const auto usable = static_cast<size_t>(first_noisy - points.begin());
    if (usable < 3) {
        const double third = points.at(2).at("mse").get<double>();
        throw run_error(fmt::format(
            "the reference is too noisy (its own RMSE is {:.3g}): only {} of {} points have errors "
            "well above its noise; three of them need a reference with {:.2g} times the samples",
            std::sqrt(noise_mse), usable, points.size(), missing_samples(third, noise_mse)));
    }
    return {{"points", points},
            {"slope", slope_of(repetitions, usable, 0)},
            {"slope_unbiased", slope_of(repetitions, usable, noise_mse)}};
}

json parse_document(const std::string &text, const std::string &source) {
    json document = parse_json(text, source);
    const auto require = [&](const std::string &name) {
        const auto schema = embedded::experiment_schemas().text("results/" + name + ".schema.json");
        validate_json(document, std::string(schema), source, text);
    };
    require("document");
    require(document.at("kind"));
    return document;
}

}  // namespace rtrays
