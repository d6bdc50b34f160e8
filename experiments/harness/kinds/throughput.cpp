// SPDX-License-Identifier: MIT
#include "experiments/harness/kinds/throughput.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "experiments/harness/core/contest.h"
#include "experiments/harness/core/document.h"

namespace rtrays {

Throughput measure_throughput(const ThroughputSettings &settings, const Contestant &renderer,
                              const Contestant &reference, const std::function<CpuUse()> &use_since,
                              const std::function<void(int)> &progress) {
    Throughput result;
    Contest contest(Clock::wall, [&] {
        const CpuUse use = use_since();
        return use.foreign + use.steal;
    });
    contest.add("renderer", [&] { return time_of(renderer); });
    contest.add("reference", [&] { return time_of(reference); });
    const auto wanted = static_cast<size_t>(settings.repetitions),
               attempts = wanted * static_cast<size_t>(settings.attempts_per_repetition);
    while (result.repetitions.size() < attempts && contest.turns() < wanted) {
        contest.turn();
        result.repetitions.push_back(
            {contest.last_seconds("renderer").wall, contest.last_seconds("reference").wall,
             contest.last_foreign_load(), contest.last_foreign_load() <= settings.foreign_limit});
        if (!result.repetitions.back().accepted) {
            contest.discard_turn();
        }
        progress(static_cast<int>(contest.turns()));
    }
    if (contest.turns() < wanted) {
        result.reason = fmt::format(
            "foreign load: in only {} of {} repetitions did other processes use at most {:.0f} % "
            "of the CPU",
            contest.turns(), result.repetitions.size(), 100 * settings.foreign_limit);
        return result;
    }
    const auto rate = [&](const char *name) {
        const Interval seconds = contest.wall_seconds(name);
        return Interval{settings.samples / seconds.value, settings.samples / seconds.high,
                        settings.samples / seconds.low};
    };
    result.accepted = true;
    result.renderer = rate("renderer");
    result.reference = rate("reference");
    result.ratio = contest.speed_over("renderer", "reference");
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
