// SPDX-License-Identifier: MIT
#include "cluster/crew.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <set>
#include <thread>

#include "cluster/range_queue.h"
#include "renderer/base/clock.h"
#include "renderer/base/progress.h"

namespace rtrays::cluster {

namespace {

/// Returns the value of an environment variable by which tests change a run, or nothing.
std::optional<std::string> test_variable(const char *name) {
    const char *value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

/// Returns the number of words that are summed at once: 64 MiB, or RTRAYS_TEST_SLAB.
size_t slab_words() {
    const auto test = test_variable("RTRAYS_TEST_SLAB");
    return test ? std::stoul(*test) : (size_t{64} << 20) / sizeof(int64_t);
}

/// Returns the factor by which a rank is slowed: RTRAYS_TEST_DELAY has the form RANK:FACTOR.
double delay_factor(const World &world) {
    const auto test = test_variable("RTRAYS_TEST_DELAY");
    const size_t colon = test ? test->find(':') : std::string::npos;
    if (colon == std::string::npos || std::stoul(test->substr(0, colon)) != world.rank()) {
        return 1;
    }
    return std::stod(test->substr(colon + 1));
}

std::string to_text(const SampleRanges &ranges) {
    Json list = Json::array();
    for (const SampleRange &range : ranges) {
        list.push_back({range.begin, range.end});
    }
    return list.dump();
}

/// Adds the films of all ranks on rank 0. All ranks call it.
FilmSums sum_films(const World &world, FilmSums film) {
    world.sum(film.words, slab_words());
    world.sum(film.numbers);
    const std::vector<std::string> all = world.gather(to_text(film.ranges));
    for (size_t rank = 1; rank < all.size(); ++rank) {
        for (const Json &range : parse_json(all[rank], "ranges of a rank")) {
            add_range(film.ranges, {range.at(0), range.at(1)});
        }
    }
    return film;
}

/// A time at which something is due again and again.
class Deadline {
  public:
    explicit Deadline(std::optional<double> interval) : interval_(interval) {}
    double seconds_left() const {
        return interval_ ? *interval_ - seconds_since(last_)
                         : std::numeric_limits<double>::infinity();
    }
    bool is_due() const { return seconds_left() <= 0; }
    void restart() { last_ = SteadyClock::now(); }

  private:
    std::optional<double> interval_;
    SteadyClock::time_point last_ = SteadyClock::now();
};

/// Rank 0: hands out ranges, and collects films.
class Coordinator {
  public:
    Coordinator(const World &world, const Work &work, const Plan &plan)
        : world_(world),
          work_(work),
          plan_(plan),
          queue_(plan.missing, world.size()),
          local_(work, delay_factor(world)),
          checkpoint_(plan.checkpoint_interval),
          preview_(plan.preview_interval),
          end_(plan.seconds),
          progress_("rendering",
                    plan.seconds ? static_cast<uint64_t>(*plan.seconds * 1000) : plan.wanted,
                    plan.seconds ? "ms" : "spp", plan.quiet) {
        outcome_.ranks.resize(world.size());
    }

    Outcome run() {
        show_progress();
        for (;;) {
            const bool news = collect();
            outcome_.interrupted = outcome_.interrupted || interrupted();
            if (!must_pause()) {
                hand_out();
            }
            if (waiting_.size() == world_.size()) {
                if (is_complete_) {
                    order_all(Order::Kind::end);
                    outcome_.seconds = seconds_since(start_);
                    return std::move(outcome_);
                }
                is_complete_ = is_finished();
                add_films(is_complete_);
            }
            show_progress();
            if (!news) {
                std::this_thread::sleep_for(std::chrono::microseconds(500));
            }
        }
    }

  private:
    bool is_finished() const { return outcome_.interrupted || queue_.empty() || end_.is_due(); }
    /// An interval may be 0; the films are then added after every range.
    bool must_pause() const {
        return is_finished() ||
               (rendered_ > summed_ && (checkpoint_.is_due() || preview_.is_due()));
    }

    /// Receives all reports that have arrived; returns whether there were any.
    bool collect() {
        const size_t before = waiting_.size();
        if (const auto report = local_.receive()) {
            note(0, *report);
        }
        while (const auto received = world_.receive()) {
            note(received->rank, received->report);
        }
        return waiting_.size() > before;
    }

    void note(size_t rank, const Report &report) {
        waiting_.insert(rank);
        outcome_.interrupted = outcome_.interrupted || report.interrupted != 0;
        const uint64_t samples = report.range.count();
        if (samples > 0) {
            queue_.note(rank, samples, report.seconds);
            RankRecord &record = outcome_.ranks[rank];
            ++record.ranges;
            record.samples += samples;
            record.seconds += report.seconds;
            rendered_ += samples;
        }
    }

    void hand_out() {
        const double horizon =
            std::min({checkpoint_.seconds_left(), preview_.seconds_left(), end_.seconds_left()});
        for (auto rank = waiting_.begin(); rank != waiting_.end();) {
            const auto range = queue_.next(*rank, horizon);
            if (!range) {
                return;
            }
            send(*rank, {Order::Kind::render, *range});
            rank = waiting_.erase(rank);
        }
    }

    void send(size_t rank, const Order &order) {
        if (rank > 0) {
            world_.send(rank, order);
        } else if (order.kind == Order::Kind::render) {
            local_.send(order);
        }
    }

    void order_all(Order::Kind kind) {
        for (size_t rank = 0; rank < world_.size(); ++rank) {
            send(rank, {kind, {0, 0}});
        }
    }

    /// Adds the films while all ranks wait, and saves or shows the sum. Ranks then report again,
    /// except rank 0, whose thread did not notice.
    void add_films(bool finished) {
        order_all(Order::Kind::sum);
        outcome_.film = sum_films(world_, work_.film());
        ++outcome_.sums;
        summed_ = rendered_;
        waiting_ = {0};
        if (plan_.save && (finished || checkpoint_.is_due())) {
            plan_.save(outcome_.film);
            checkpoint_.restart();
        }
        if (!finished && preview_.is_due()) {
            plan_.preview(outcome_.film);
            preview_.restart();
        }
    }

    void show_progress() {
        const double elapsed = seconds_since(start_);
        const uint64_t missing = count_samples(plan_.missing);
        const uint64_t done = plan_.seconds
                                  ? static_cast<uint64_t>(std::min(elapsed, *plan_.seconds) * 1000)
                                  : plan_.wanted - missing + rendered_;
        progress_.update(done, [this] { return describe_speed(); });
    }

    std::string describe_speed() const {
        const double total = queue_.total_rate();
        if (total == 0) {
            return "";
        }
        std::string text = fmt::format(", {:.3g} million samples/s",
                                       total * static_cast<double>(plan_.pixels) / 1e6);
        size_t slowest = 0;
        for (size_t rank = 0; rank < world_.size(); ++rank) {
            if (queue_.rate(rank) > 0 &&
                (queue_.rate(rank) < queue_.rate(slowest) || queue_.rate(slowest) == 0)) {
                slowest = rank;
            }
        }
        if (world_.size() > 1) {
            text += fmt::format(
                ", rank {} is the slowest with {:.0f} % of the mean", slowest,
                100 * queue_.rate(slowest) * static_cast<double>(world_.size()) / total);
        }
        return text;
    }

    const World &world_;
    const Work &work_;
    const Plan &plan_;
    RangeQueue queue_;
    LocalWorker local_;
    std::set<size_t> waiting_;            ///< ranks without an order
    bool is_complete_ = false;            ///< the film of the outcome is the last one
    uint64_t rendered_ = 0, summed_ = 0;  ///< samples so far, and at the last sum
    Outcome outcome_;
    const SteadyClock::time_point start_ = SteadyClock::now();
    Deadline checkpoint_, preview_, end_;
    Progress progress_;
};

}  // namespace

std::optional<Outcome> render_together(const World &world, const Work &work,
                                       const std::optional<Plan> &plan) {
    for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
        interrupt_on(signal);
    }
    if (plan) {
        return Coordinator(world, work, *plan).run();
    }
    follow(
        work, delay_factor(world), [&](const Report &report) { return world.exchange(report); },
        [&] { sum_films(world, work.film()); });
    return std::nullopt;
}

Json describe_job(const World &world, const std::optional<Outcome> &outcome) {
    const std::vector<std::string> hosts = world.gather(world.host());
    if (!outcome) {
        return {};
    }
    Json ranks = Json::array();
    for (size_t rank = 0; rank < hosts.size(); ++rank) {
        const RankRecord &record = outcome->ranks[rank];
        ranks.push_back({{"host", hosts[rank]},
                         {"ranges", record.ranges},
                         {"samples", record.samples},
                         {"seconds", record.seconds}});
    }
    return {{"seconds", outcome->seconds},
            {"sums", outcome->sums},
            {"summed_bytes", outcome->sums * outcome->film.words.size() * sizeof(int64_t)},
            {"ranks", ranks}};
}

}  // namespace rtrays::cluster
