// SPDX-License-Identifier: MIT
// Progress messages, and interruption of long runs by signals.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "renderer/base/clock.h"

namespace rtrays {

/// Estimate of the time that is left. It ignores the first step, which often compiles kernels, and
/// units that were complete before.
class RemainingTime {
  public:
    /// Reports that `done` units are complete after `seconds`. Both grow.
    void update(uint64_t done, double seconds);

    /// Returns the seconds until `total` units are complete, or nothing before the second step.
    std::optional<double> until(uint64_t total) const;

  private:
    struct Step {
        uint64_t done;
        double seconds;
    };
    std::optional<Step> first_, last_;
};

/// Progress and estimated time left on stderr. On a terminal, one line is updated in place;
/// otherwise a line is printed every ten seconds. Prints nothing if `quiet`.
class Progress {
  public:
    /// `total`, and later `done`, are in units of `what` ("spp", "curves").
    Progress(std::string task, uint64_t total, std::string what, bool quiet);
    ~Progress();
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    /// Reports that `done` of `total` units are complete. The first call starts the clock. What
    /// `note` returns is appended to a message that is printed.
    void update(uint64_t done, const std::function<std::string()> &note = {});

  private:
    void print(uint64_t done, const char *end) const;

    std::string task_;
    std::string note_;
    uint64_t total_;
    std::string what_;
    bool quiet_;
    bool terminal_;
    bool started_ = false;
    bool drawn_ = false;
    uint64_t last_done_ = 0;
    RemainingTime left_;
    SteadyClock::time_point start_;
    SteadyClock::time_point last_print_;
};

/// Tells on stderr that a long step without units is running: on a terminal after a second, in a
/// line that disappears at the end; otherwise in a line every ten seconds.
class Waiting {
  public:
    Waiting(std::string task, bool quiet);
    ~Waiting();
    Waiting(const Waiting &) = delete;
    Waiting &operator=(const Waiting &) = delete;

  private:
    void tell();

    std::string task_;
    bool terminal_;
    bool drawn_ = false;
    bool done_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::thread thread_;
};

/// Returns whether SIGINT or SIGTERM arrived since `install_interrupt_handler` was called. Long
/// loops poll it, save a state that can be resumed, and return.
bool interrupted();
/// Installs the handler of SIGINT and SIGTERM. A second signal ends the process at once.
void install_interrupt_handler();
/// Installs the handler of another signal, which may arrive again without effect. A job of many
/// processes gets the same signal from several sides.
void interrupt_on(int signal);

/// While an object lives, the first SIGINT or SIGTERM ends the process, with exit code 130. For
/// long steps that do not poll `interrupted` and have no results yet.
class InterruptsEndAtOnce {
  public:
    InterruptsEndAtOnce();
    ~InterruptsEndAtOnce() { install_interrupt_handler(); }
    InterruptsEndAtOnce(const InterruptsEndAtOnce &) = delete;
    InterruptsEndAtOnce &operator=(const InterruptsEndAtOnce &) = delete;
};

}  // namespace rtrays
