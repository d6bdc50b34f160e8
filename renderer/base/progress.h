// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace rtrays {

/// Progress with time left on stderr: one line redrawn in place on a terminal, otherwise a line
/// every ten seconds. Silent when `quiet`.
class Progress {
  public:
    /// `total` and later `done` are in units of `what` ("spp", "curves").
    Progress(std::string task, uint64_t total, std::string what, bool quiet);
    ~Progress();
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    /// `done` counts from 0 to `total`; what was done before the first call is not used for the
    /// estimate.
    void update(uint64_t done);

  private:
    using Clock = std::chrono::steady_clock;

    void print(uint64_t done, const char *end) const;

    std::string task_;
    uint64_t total_;
    std::string what_;
    bool quiet_;
    bool terminal_;
    bool started_ = false;
    bool drawn_ = false;
    uint64_t first_done_ = 0;
    uint64_t last_done_ = 0;
    Clock::time_point start_;
    Clock::time_point last_print_;
};

/// Set by SIGINT or SIGTERM once `install_interrupt_handler` was called: long loops poll it, leave
/// a resumable state and return.
bool interrupted();
void install_interrupt_handler();

}  // namespace rtrays
