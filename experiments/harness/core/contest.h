// SPDX-License-Identifier: MIT
// Times several contestants for one task in interleaved repetitions, so that temporary slowdowns of
// the machine affect all of them.
#pragma once

#include <chrono>
#include <ctime>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/harness/core/statistics.h"
#include "renderer/device/context.h"

namespace rtrays {

/// Duration of one run: wall time, and processor time of all threads of this process.
struct Seconds {
    double wall, processor;
};

/// Runs `work` and returns its duration.
template <typename Work>
Seconds time_of(const Work &work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    work();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC};
}

/// Clock by which speeds are compared.
enum class Clock {
    processor,  ///< processor time of all threads, which other load hardly changes
    wall        ///< wall time, for GPUs
};

/// Returns the clock for a device.
inline Clock clock_of(const DeviceInfo &device) {
    return device.is_cpu ? Clock::processor : Clock::wall;
}

/// Interleaved repetitions ("turns") of all contestants.
class Contest {
  public:
    /// Returns the share of the machine's processor time that other processes and the hypervisor
    /// used since the previous call.
    using ForeignLoad = std::function<double()>;

    explicit Contest(Clock clock = Clock::processor, ForeignLoad foreign = measured_foreign_load())
        : clock_(clock), foreign_since_(std::move(foreign)) {}

    /// Adds a contestant. `run` does the work once and returns its duration without preparation.
    void add(const std::string &name, const std::function<Seconds()> &run);

    /// Runs every contestant once. Every second turn runs them in reverse order.
    void turn();

    /// Times and foreign load of the last turn.
    Seconds last_seconds(const std::string &name) const { return find(name).times.back(); }
    double last_foreign_load() const { return foreign_.back(); }

    /// Forgets the last turn, for instance because of foreign load.
    void discard_turn();

    size_t turns() const { return foreign_.size(); }
    std::vector<std::string> names() const;

    /// Return medians with 95 % intervals. Throw `Error` (run failed) for fewer than 6 turns, and
    /// std::out_of_range for an unknown name.
    Interval wall_seconds(const std::string &name) const;
    Interval processor_seconds(const std::string &name) const;

    /// Returns the speed of `name` relative to `other` by the contest's clock: the median of the
    /// ratios within turns. Throws like `wall_seconds`.
    Interval speed_over(const std::string &name, const std::string &other) const;

    /// Returns the share of the machine's processor time that other processes and the hypervisor
    /// used during a turn (median over the turns).
    double foreign_load() const;

  private:
    struct Contestant {
        std::string name;
        std::function<Seconds()> run;
        std::vector<Seconds> times{};
    };
    const Contestant &find(const std::string &name) const;
    static ForeignLoad measured_foreign_load();

    Clock clock_;
    ForeignLoad foreign_since_;
    std::vector<Contestant> contestants_;
    size_t started_ = 0;  ///< turns, including discarded ones
    std::vector<double> foreign_;
};

}  // namespace rtrays
