// SPDX-License-Identifier: MIT
#include "renderer/base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <string_view>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

std::atomic<bool> interrupt_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free,
              "a signal handler may only access a lock-free flag");

std::string format_duration(double seconds) {
    const auto s = static_cast<uint64_t>(seconds + 0.5);
    if (s >= 3600) {
        return fmt::format("{}h{:02}m", s / 3600, s / 60 % 60);
    }
    return fmt::format("{}m{:02}s", s / 60, s % 60);
}

}  // namespace

void RemainingTime::update(uint64_t done, double seconds) {
    if (last_ && done > last_->done && !first_) {
        first_ = {done, seconds};
    }
    last_ = {done, seconds};
}

std::optional<double> RemainingTime::until(uint64_t total) const {
    if (!first_ || last_->done == first_->done) {
        return std::nullopt;
    }
    const double rate = static_cast<double>(last_->done - first_->done) /
                        std::max(last_->seconds - first_->seconds, 1e-9);
    return static_cast<double>(total - last_->done) / rate;
}

Progress::Progress(std::string task, uint64_t total, std::string what, bool quiet)
    : task_(std::move(task)),
      total_(total),
      what_(std::move(what)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO)) {}

Progress::~Progress() {
    if (drawn_) {
        print(last_done_, "\n");
    }
}

void Progress::update(uint64_t done, const std::function<std::string()> &note) {
    const auto now = SteadyClock::now();
    if (!started_) {
        started_ = true;
        start_ = last_print_ = now;
    }
    last_done_ = done;
    left_.update(done, seconds_since(start_));
    const auto interval =
        terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10000);
    if (quiet_ || now - last_print_ < interval) {
        return;
    }
    last_print_ = now;
    drawn_ = terminal_;
    note_ = note ? note() : "";
    print(done, terminal_ ? "" : "\n");
}

void Progress::print(uint64_t done, const char *end) const {
    const std::optional<double> left = left_.until(total_);
    fmt::print(stderr, "{}{}: {} / {} {}, {} elapsed, {} left{}{}{}", terminal_ ? "\r" : "", task_,
               done, total_, what_, format_duration(seconds_since(start_)),
               left ? format_duration(*left) : "?", note_, terminal_ ? "\x1b[K" : "", end);
    std::fflush(stderr);
}

Waiting::Waiting(std::string task, bool quiet)
    : task_(std::move(task)), terminal_(isatty(STDERR_FILENO)) {
    if (!quiet) {
        thread_ = std::thread([this] { tell(); });
    }
}

Waiting::~Waiting() {
    if (!thread_.joinable()) {
        return;
    }
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        done_ = true;
    }
    changed_.notify_all();
    thread_.join();
    if (drawn_) {
        fmt::print(stderr, "\r\x1b[K");
        std::fflush(stderr);
    }
}

void Waiting::tell() {
    const auto start = SteadyClock::now();
    const auto interval = std::chrono::seconds(terminal_ ? 1 : 10);
    std::unique_lock<std::mutex> lock(mutex_);
    while (!changed_.wait_for(lock, interval, [&] { return done_; })) {
        const std::string elapsed = format_duration(seconds_since(start));
        fmt::print(stderr, "{}{}: {} elapsed{}", terminal_ ? "\r" : "", task_, elapsed,
                   terminal_ ? "\x1b[K" : "\n");
        std::fflush(stderr);
        drawn_ = terminal_;
    }
}

bool interrupted() {
    return interrupt_flag.load(std::memory_order_relaxed);
}

namespace {

void handle_interrupts(int signal, int flags) {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupt_flag.store(true, std::memory_order_relaxed); };
    action.sa_flags = flags;
    sigaction(signal, &action, nullptr);
}

}  // namespace

void install_interrupt_handler() {
    handle_interrupts(SIGINT, SA_RESETHAND);  // a second signal ends the process at once
    handle_interrupts(SIGTERM, SA_RESETHAND);
}

void interrupt_on(int signal) {
    handle_interrupts(signal, 0);
}

namespace {

void end_at_once(int /*signal*/) {
    constexpr std::string_view message = "\ninterrupted\n";
    const ssize_t ignored = write(STDERR_FILENO, message.data(), message.size());
    static_cast<void>(ignored);
    _exit(static_cast<int>(ExitCode::interrupted));
}

}  // namespace

InterruptsEndAtOnce::InterruptsEndAtOnce() {
    struct sigaction action {};
    action.sa_handler = end_at_once;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    if (interrupted()) {  // before
        end_at_once(SIGINT);
    }
}

}  // namespace rtrays
