// SPDX-License-Identifier: MIT
#include "experiments/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "embedded/experiment_schemas.h"
#include "renderer/base/error.h"
#include "renderer/base/json.h"

namespace rtrays {

using nlohmann::json;

namespace {

/// The median over seeds of one number at one rung.
template <typename Get>
double median_of(const std::vector<Repetition> &repetitions, size_t point, Get get) {
    std::vector<double> values;
    for (const auto &repetition : repetitions) {
        values.push_back(get(repetition.points[point]));
    }
    return median(values);
}

json summarise_point(const std::vector<Repetition> &repetitions, size_t point, double noise_mse) {
    const auto of = [&](auto get) { return median_of(repetitions, point, get); };
    const double mse = of([](const Measurement &m) { return m.error.mse; });
    json raw = json::array();
    for (const auto &repetition : repetitions) {
        const auto &measurement = repetition.points[point];
        json entry = to_json(measurement.error);
        entry["seed"] = repetition.seed;
        entry["seconds_device"] = measurement.seconds_device;
        entry["seconds_wall"] = measurement.seconds_wall;
        raw.push_back(entry);
    }
    return {{"spp", repetitions.front().points[point].spp},
            {"seconds_device", of([](const Measurement &m) { return m.seconds_device; })},
            {"seconds_wall", of([](const Measurement &m) { return m.seconds_wall; })},
            {"l2", of([](const Measurement &m) { return m.error.l2; })},
            {"rmse", of([](const Measurement &m) { return m.error.rmse; })},
            {"mae", of([](const Measurement &m) { return m.error.mae; })},
            {"relmse", of([](const Measurement &m) { return m.error.relmse; })},
            {"mse", mse},
            {"mse_unbiased", unbiased_mse(mse, noise_mse)},
            {"noise_dominates", noise_dominates(mse, noise_mse)},
            {"repetitions", raw}};
}

/// The slope over the first `count` rungs, of the RMSE or of the RMSE less the reference's noise.
json slope_of(const std::vector<Repetition> &repetitions, size_t count, double noise_mse) {
    std::vector<double> spp;
    std::vector<std::vector<double>> errors;
    for (size_t p = 0; p < count; ++p) {
        spp.push_back(static_cast<double>(repetitions.front().points[p].spp));
    }
    for (const auto &repetition : repetitions) {
        errors.emplace_back();
        for (size_t p = 0; p < count; ++p) {
            errors.back().push_back(std::sqrt(unbiased_mse(repetition.points[p].error.mse, noise_mse)));
        }
    }
    json slope = to_json(convergence_slope(spp, errors));
    slope["confidence"] = 0.95;
    slope["spp"] = {repetitions.front().points.front().spp, repetitions.front().points[count - 1].spp};
    return slope;
}

}  // namespace

json to_json(const Interval &interval) {
    return {{"value", interval.value}, {"low", interval.low}, {"high", interval.high}};
}

json to_json(const ErrorMetrics &metrics) {
    return {{"l2", metrics.l2},
            {"rmse", metrics.rmse},
            {"mae", metrics.mae},
            {"relmse", metrics.relmse},
            {"mse", metrics.mse}};
}

json to_json(const Agreement &agreement, const AgreementPolicy &policy) {
    json difference = to_json(agreement.relative_difference);
    difference["confidence"] = policy.confidence;
    difference["limit"] = policy.equivalence_limit;
    return {{"block_size", policy.block_size},
            {"alpha", policy.alpha},
            {"tests", agreement.tests.size()},
            {"rejected", agreement.rejected},
            {"agrees", agreement.agrees()},
            {"largest_z", agreement.largest_z},
            {"smallest_adjusted_p", agreement.smallest_adjusted_p},
            {"relative_difference", difference},
            {"equivalence", to_string(agreement.equivalence)}};
}

json to_json(const Repetition &repetition) {
    json points = json::array();
    for (const auto &measurement : repetition.points) {
        json point = to_json(measurement.error);
        point["spp"] = measurement.spp;
        point["seconds_device"] = measurement.seconds_device;
        point["seconds_wall"] = measurement.seconds_wall;
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
        point.at("l2").get_to(measurement.error.l2);
        point.at("rmse").get_to(measurement.error.rmse);
        point.at("mae").get_to(measurement.error.mae);
        point.at("relmse").get_to(measurement.error.relmse);
        point.at("mse").get_to(measurement.error.mse);
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
        throw run_error(
            fmt::format("the reference (RMSE of its own noise {:.3g}) is too noisy: only {} of {} points lie "
                        "above its floor; make a "
                        "reference with more samples per pixel (make references)",
                        std::sqrt(noise_mse), usable, points.size()));
    }
    return {{"points", points},
            {"slope", slope_of(repetitions, usable, 0)},
            {"slope_unbiased", slope_of(repetitions, usable, noise_mse)}};
}

void check_run(const json &run, const std::string &source) {
    try {
        validate_json(run, std::string(embedded::experiment_schemas().text("run.schema.json")), source);
    } catch (const Error &error) {
        throw run_error(fmt::format("the run is incomplete and was not written: {}", error.what()));
    }
}

}  // namespace rtrays
