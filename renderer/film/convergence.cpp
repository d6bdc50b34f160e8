// SPDX-License-Identifier: MIT
#include "renderer/film/convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace rtrays {

std::string ConvergenceRule::describe() const {
    return fmt::format("biased by convergence control: error {}, interval {}, start {}", error,
                       interval, start);
}

uint64_t ConvergenceState::camera_paths(uint64_t samples) const {
    uint64_t paths = 0;
    for (size_t pixel = 0; pixel < stopped_at.size(); ++pixel) {
        paths += samples_of(pixel, samples);
    }
    return paths;
}

bool ConvergenceState::is_consistent(uint64_t samples) const {
    return std::all_of(stopped_at.begin(), stopped_at.end(), [&](uint64_t at) {
        return at == 0 || (at <= samples && rule.is_check(at));
    });
}

nlohmann::json convergence_report(const ConvergenceState &state, uint64_t samples) {
    nlohmann::json report = {{"error", state.rule.error},
                             {"interval", state.rule.interval},
                             {"start", state.rule.start},
                             {"camera_paths", state.camera_paths(samples)},
                             {"checks", nlohmann::json::array()}};
    std::map<uint64_t, uint64_t> stops;  // number of pixels by the check at which they stopped
    for (const uint64_t at : state.stopped_at) {
        ++stops[at];
    }
    uint64_t live = state.stopped_at.size();
    for (uint64_t check = state.rule.start; check <= samples; check += state.rule.interval) {
        const auto stopped = stops.find(check);
        live -= stopped == stops.end() ? 0 : stopped->second;
        report["checks"].push_back(
            {{"samples", check},
             {"live", static_cast<double>(live) / static_cast<double>(state.stopped_at.size())}});
    }
    return report;
}

}  // namespace rtrays
