// SPDX-License-Identifier: MIT
// Samples per second of renderer and reference in turns on one machine.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/host.h"
#include "experiments/statistics.h"

namespace rtrays {

/// Renders `ThroughputSettings::samples` camera paths; warmed up.
using Contestant = std::function<void()>;

struct ThroughputSettings {
    int repetitions = 9;         ///< accepted ones, at least 9
    double samples = 0;          ///< camera paths of one `render`
    double foreign_limit = 0.1;  ///< share of all CPU time that others (and the hypervisor) may use
    int attempts_per_repetition = 3;
};

/// One turn of both.
struct ThroughputRepetition {
    double renderer_seconds = 0, reference_seconds = 0;  ///< wall
    double foreign = 0;  ///< share of CPU time used by others, steal included
    bool accepted = false;
};

struct Throughput {
    std::vector<ThroughputRepetition> repetitions;
    bool accepted =
        false;  ///< enough repetitions without foreign load; otherwise no figures are given
    std::string reason;            ///< why not
    Interval renderer, reference;  ///< samples per second, median with 95 % interval
    Interval ratio;                ///< renderer over reference, from the repetitions' own ratios
};

/// Renders in the order AB BA AB ... until enough repetitions ran undisturbed or the attempts are
/// used up. `use_since` tells the CPU use since its previous call (replaced in tests); `progress`
/// is told the number of accepted repetitions.
Throughput measure_throughput(const ThroughputSettings &settings, const Contestant &renderer,
                              const Contestant &reference, const std::function<CpuUse()> &use_since,
                              const std::function<void(int)> &progress);

/// As run.json holds it.
Json to_json(const Throughput &throughput, const ThroughputSettings &settings);

}  // namespace rtrays
