// SPDX-License-Identifier: MIT
// Measures the samples per second of renderer and reference in interleaved repetitions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/harness/core/host.h"
#include "experiments/harness/core/statistics.h"

namespace rtrays {

/// Renders `ThroughputSettings::samples` camera paths. It has been warmed up before.
using Contestant = std::function<void()>;

struct ThroughputSettings {
    int repetitions = 9;  ///< number of accepted repetitions, at least 9
    double samples = 0;   ///< camera paths of one call of a `Contestant`
    /// Largest share of the CPU time that other processes and the hypervisor may use.
    double foreign_limit = 0.1;
    int attempts_per_repetition = 3;
};

/// One repetition of both contestants.
struct ThroughputRepetition {
    double renderer_seconds = 0, reference_seconds = 0;  ///< wall time
    double foreign = 0;  ///< share of CPU time used by other processes and the hypervisor
    bool accepted = false;
};

struct Throughput {
    std::vector<ThroughputRepetition> repetitions;
    /// Whether enough repetitions ran without foreign load. If not, there are no results.
    bool accepted = false;
    std::string reason;            ///< why the measurement was not accepted
    Interval renderer, reference;  ///< samples per second, median with 95 % interval
    Interval ratio;                ///< renderer over reference: median of the repetitions' ratios
};

/// Renders in the order AB BA AB ... until enough repetitions are accepted or the attempts are used
/// up. `use_since` returns the CPU use since its previous call (tests replace it). `progress` is
/// called with the number of accepted repetitions.
Throughput measure_throughput(const ThroughputSettings &settings, const Contestant &renderer,
                              const Contestant &reference, const std::function<CpuUse()> &use_since,
                              const std::function<void(int)> &progress);

/// Writes "throughput" of run.json.
Json to_json(const Throughput &throughput, const ThroughputSettings &settings);

}  // namespace rtrays
