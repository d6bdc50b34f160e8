// SPDX-License-Identifier: MIT
// Several ways to do one thing, timed in turns: what is slow for a while is slow for all of them.
#pragma once

#include <chrono>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "experiments/statistics.h"
#include "renderer/device/context.h"

namespace rtrays {

/// Seconds of one run: by the clock on the wall, and of processor by all threads of this process.
struct Seconds {
    double wall, processor;
};

template <typename Work>
Seconds time_of(const Work &work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    work();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC};
}

/// What speeds compare.
enum class Clock {
    processor,  ///< of all threads: other load on the machine hardly changes it
    wall        ///< where a GPU works
};

inline Clock clock_of(const DeviceInfo &device) {
    return device.is_cpu ? Clock::processor : Clock::wall;
}

class Contest {
  public:
    explicit Contest(Clock clock = Clock::processor) : clock_(clock) {}

    /// `run` does the work once and says what it took; what it prepares before need not be timed.
    void add(const std::string &name, const std::function<Seconds()> &run);

    /// Every contestant once; every second turn in reverse order.
    void turn();

    size_t turns() const { return turns_; }
    std::vector<std::string> names() const;

    /// Medians with 95 % intervals; at least 6 turns are needed, `Error` (run failed) otherwise.
    /// Throws std::out_of_range for a name that is not there.
    Interval wall_seconds(const std::string &name) const;
    Interval processor_seconds(const std::string &name) const;

    /// How many times faster `name` is than `other` by this clock, turn by turn.
    Interval speed_over(const std::string &name, const std::string &other) const;

    /// Share of the machine's processor time that others used during the turns, what the hypervisor
    /// took included.
    double foreign_load() const;

  private:
    struct Contestant {
        std::string name;
        std::function<Seconds()> run;
        std::vector<Seconds> times{};
    };
    const Contestant &find(const std::string &name) const;

    Clock clock_;
    std::vector<Contestant> contestants_;
    size_t turns_ = 0;
    std::vector<double> foreign_;
};

}  // namespace rtrays
