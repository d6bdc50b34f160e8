// SPDX-License-Identifier: MIT
// The part of a rank that renders.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "cluster/world.h"
#include "renderer/base/clock.h"
#include "renderer/base/progress.h"
#include "renderer/base/sample_ranges.h"

namespace rtrays::cluster {

/// The film of one rank, or of all.
struct FilmSums {
    std::vector<int64_t> words;   ///< of the exact sums; as a sum over ranks, without carries
    std::vector<double> numbers;  ///< seconds, and counts below 2^53, which add as well
    SampleRanges ranges;
};

/// What a rank can do.
struct Work {
    /// Renders samples; returns the end of those that are done, earlier if interrupted.
    std::function<uint64_t(SampleRange)> render;
    /// Returns all that this rank has rendered, and on rank 0 what was restored.
    std::function<FilmSums()> film;
};

/// Follows orders. `exchange` sends a report and returns the next order, `sum` follows
/// `Order::Kind::sum`.
template <class Exchange, class Sum>
void follow(const Work &work, double delay, const Exchange &exchange, const Sum &sum) {
    Report report;
    for (;;) {
        const Order order = exchange(report);
        report = {};
        if (order.kind == Order::Kind::end) {
            return;
        }
        if (order.kind == Order::Kind::sum) {
            sum();
            continue;
        }
        const auto start = SteadyClock::now();
        const uint64_t end = work.render(order.range);
        std::this_thread::sleep_for(
            std::chrono::duration<double>(seconds_since(start) * (delay - 1)));
        report = {{order.range.begin, end}, seconds_since(start), interrupted() ? 1u : 0u};
    }
}

/// The thread of rank 0 that renders. The main thread is the one that calls MPI.
class LocalWorker {
  public:
    LocalWorker(const Work &work, double delay)
        : thread_([this, &work, delay] {
              try {
                  follow(
                      work, delay, [this](const Report &report) { return exchange(report); },
                      [] {});
              } catch (...) {
                  const std::lock_guard<std::mutex> lock(mutex_);
                  failure_ = std::current_exception();
              }
          }) {}
    ~LocalWorker() {
        send({Order::Kind::end, {0, 0}});
        thread_.join();
    }
    LocalWorker(const LocalWorker &) = delete;
    LocalWorker &operator=(const LocalWorker &) = delete;

    void send(const Order &order) {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            order_ = order;
        }
        changed_.notify_all();
    }

    /// Returns a report, or nothing. Throws what has ended the thread.
    std::optional<Report> receive() {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (failure_) {
            std::rethrow_exception(failure_);
        }
        return std::exchange(report_, std::nullopt);
    }

  private:
    Order exchange(const Report &report) {
        std::unique_lock<std::mutex> lock(mutex_);
        report_ = report;
        changed_.wait(lock, [this] { return order_.has_value(); });
        const Order order = *order_;
        order_.reset();
        return order;
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<Order> order_;
    std::optional<Report> report_;
    std::exception_ptr failure_;
    std::thread thread_;  // the last member, because it uses the others
};

}  // namespace rtrays::cluster
