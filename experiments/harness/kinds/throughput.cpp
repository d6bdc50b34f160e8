// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/throughput.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "experiments/harness/core/document.h"

namespace rtrays {

namespace {

double wall_seconds(const Contestant &render) {
    const auto start = std::chrono::steady_clock::now();
    render();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Throughput measure_throughput(const ThroughputSettings &settings, const Contestant &renderer,
                              const Contestant &reference, const std::function<CpuUse()> &use_since,
                              const std::function<void(int)> &progress) {
    Throughput result;
    std::vector<double> renderer_rates, reference_rates, ratios;
    const int attempts = settings.repetitions * settings.attempts_per_repetition;
    for (int attempt = 0;
         attempt < attempts && static_cast<int>(ratios.size()) < settings.repetitions; ++attempt) {
        ThroughputRepetition turn;
        use_since();
        if (attempt % 2 == 0) {
            turn.renderer_seconds = wall_seconds(renderer);
            turn.reference_seconds = wall_seconds(reference);
        } else {
            turn.reference_seconds = wall_seconds(reference);
            turn.renderer_seconds = wall_seconds(renderer);
        }
        const CpuUse use = use_since();
        turn.foreign = use.foreign + use.steal;
        turn.accepted = turn.foreign <= settings.foreign_limit;
        result.repetitions.push_back(turn);
        if (turn.accepted) {
            renderer_rates.push_back(settings.samples / turn.renderer_seconds);
            reference_rates.push_back(settings.samples / turn.reference_seconds);
            ratios.push_back(turn.reference_seconds / turn.renderer_seconds);
        }
        progress(static_cast<int>(ratios.size()));
    }
    if (static_cast<int>(ratios.size()) < settings.repetitions) {
        result.reason = fmt::format(
            "foreign load: in only {} of {} repetitions did other processes use at most {:.0f} % "
            "of the CPU",
            ratios.size(), result.repetitions.size(), 100 * settings.foreign_limit);
        return result;
    }
    result.accepted = true;
    result.renderer = median_interval(renderer_rates);
    result.reference = median_interval(reference_rates);
    result.ratio = median_interval(ratios);
    return result;
}

Json to_json(const Throughput &throughput, const ThroughputSettings &settings) {
    Json json;
    json["samples_per_repetition"] = settings.samples;
    json["accepted"] = throughput.accepted;
    json["repetitions"] = Json::array();
    for (const auto &turn : throughput.repetitions) {
        json["repetitions"].push_back({{"renderer_seconds_wall", turn.renderer_seconds},
                                       {"reference_seconds_wall", turn.reference_seconds},
                                       {"foreign_load", turn.foreign},
                                       {"accepted", turn.accepted}});
    }
    if (throughput.accepted) {
        json["renderer_samples_per_second"] = to_json(throughput.renderer);
        json["reference_samples_per_second"] = to_json(throughput.reference);
        json["ratio"] = to_json(throughput.ratio);
    } else {
        json["reason"] = throughput.reason;
    }
    return json;
}

}  // namespace rtrays
