// SPDX-License-Identifier: MIT
#include "experiments/throughput.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "experiments/document.h"

namespace rtrays {

namespace {

double wall_seconds(const std::function<void()> &body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Throughput measure_throughput(const ThroughputSettings &settings, const Contestant &first,
                              const Contestant &second, const std::function<CpuUse()> &use_since,
                              const std::function<void(int)> &progress) {
    Throughput result;
    std::vector<double> first_rates, second_rates, ratios;
    const int attempts = settings.repetitions * settings.attempts_per_repetition;
    for (int attempt = 0; attempt < attempts && static_cast<int>(ratios.size()) < settings.repetitions;
         ++attempt) {
        ThroughputRepetition turn;
        use_since();
        if (attempt % 2 == 0) {
            turn.first_seconds = wall_seconds(first.render);
            turn.second_seconds = wall_seconds(second.render);
        } else {
            turn.second_seconds = wall_seconds(second.render);
            turn.first_seconds = wall_seconds(first.render);
        }
        const CpuUse use = use_since();
        turn.foreign = use.foreign + use.steal;
        turn.accepted = turn.foreign <= settings.foreign_limit;
        result.repetitions.push_back(turn);
        if (turn.accepted) {
            first_rates.push_back(settings.samples / turn.first_seconds);
            second_rates.push_back(settings.samples / turn.second_seconds);
            ratios.push_back(turn.second_seconds / turn.first_seconds);
        }
        progress(static_cast<int>(ratios.size()));
    }
    if (static_cast<int>(ratios.size()) < settings.repetitions) {
        result.reason =
            fmt::format("foreign load: only {} of {} repetitions had others use at most {:.0f} % of the CPU",
                        ratios.size(), result.repetitions.size(), 100 * settings.foreign_limit);
        return result;
    }
    result.accepted = true;
    result.first = median_interval(first_rates);
    result.second = median_interval(second_rates);
    result.ratio = median_interval(ratios);
    return result;
}

Json to_json(const Throughput &throughput, const ThroughputSettings &settings, const std::string &first,
             const std::string &second) {
    Json json;
    json["samples_per_repetition"] = settings.samples;
    json["accepted"] = throughput.accepted;
    json["repetitions"] = Json::array();
    for (const auto &turn : throughput.repetitions) {
        json["repetitions"].push_back({{first + "_seconds_wall", turn.first_seconds},
                                       {second + "_seconds_wall", turn.second_seconds},
                                       {"foreign_load", turn.foreign},
                                       {"accepted", turn.accepted}});
    }
    if (throughput.accepted) {
        json[first + "_samples_per_second"] = to_json(throughput.first);
        json[second + "_samples_per_second"] = to_json(throughput.second);
        json["ratio"] = to_json(throughput.ratio);
    } else {
        json["reason"] = throughput.reason;
    }
    return json;
}

}  // namespace rtrays
