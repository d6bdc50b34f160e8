// SPDX-License-Identifier: MIT
#include "cluster/range_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <random>
#include <utility>

namespace rtrays::cluster {
namespace {

constexpr double forever = std::numeric_limits<double>::infinity();

/// Ranks of constant speed, in a world without a clock.
struct Crew {
    std::vector<double> rates;     ///< samples per second
    std::vector<double> starts;    ///< seconds; empty: all at 0
    double seconds_per_range = 0;  ///< in which rank 0 hands out a range

    double start(size_t rank) const { return starts.empty() ? 0.0 : starts[rank]; }
    double ideal_seconds(uint64_t samples) const {
        return static_cast<double>(samples) / std::accumulate(rates.begin(), rates.end(), 0.0);
    }
    /// Returns when the last rank ends if all have equal parts.
    double static_seconds(uint64_t samples) const {
        double last = 0;
        for (size_t rank = 0; rank < rates.size(); ++rank) {
            const double part = static_cast<double>(samples) / static_cast<double>(rates.size());
            last = std::max(last, start(rank) + part / rates[rank]);
        }
        return last;
    }
};

/// What a simulated render found.
struct Simulation {
    double seconds = 0;
    double last_range = 0;  ///< seconds of the longest range that ended last on its rank
    size_t ranges = 0;
    SampleRanges rendered;
};

Simulation simulate(const Crew &crew, SampleRanges missing) {
    const size_t ranks = crew.rates.size();
    RangeQueue queue(std::move(missing), ranks);
    Simulation simulation;
    std::vector<double> last(ranks, 0);
    using Event = std::pair<double, size_t>;  // when a rank is free
    std::priority_queue<Event, std::vector<Event>, std::greater<>> free;
    for (size_t rank = 0; rank < ranks; ++rank) {
        free.emplace(crew.start(rank), rank);
    }
    double root_free = 0;
    while (!free.empty()) {
        const auto [now, rank] = free.top();
        free.pop();
        simulation.seconds = std::max(simulation.seconds, now);
        const auto range = queue.next(rank, forever);
        if (!range) {
            continue;
        }
        root_free = std::max(root_free, now) + crew.seconds_per_range;
        last[rank] = static_cast<double>(range->count()) / crew.rates[rank];
        queue.note(rank, range->count(), last[rank]);
        free.emplace(root_free + last[rank], rank);
        simulation.rendered.push_back(*range);
        ++simulation.ranges;
    }
    simulation.last_range = *std::max_element(last.begin(), last.end());
    return simulation;
}

SampleRanges united(const SampleRanges &ranges) {
    SampleRanges all;
    for (const SampleRange &range : ranges) {
        add_range(all, range);
    }
    return all;
}

TEST(RangeQueue, HandsOutEverySampleOnce) {
    const SampleRanges missing{{3, 4}, {10, 500}, {501, 502}};
    EXPECT_EQ(united(simulate({{7.0, 100.0, 31.0}, {}, 0}, missing).rendered), missing);
    EXPECT_EQ(united(simulate({{1.0}, {}, 0}, missing).rendered), missing);
    EXPECT_TRUE(simulate({{1.0, 2.0}, {}, 0}, {}).rendered.empty());
}

/// A rank that is ten times slower costs at most one of the last ranges. A static split waits for
/// it.
TEST(RangeQueue, EndsWithinOneRangeOfTheIdealTime) {
    for (const size_t ranks : {2, 4, 64}) {
        Crew crew;
        for (size_t i = 0; i < ranks; ++i) {
            crew.rates.push_back(i == 1 ? 40.0 : 400.0 + static_cast<double>(i % 7));
        }
        const uint64_t samples = 200000;
        const Simulation simulation = simulate(crew, {{0, samples}});
        const double ideal = crew.ideal_seconds(samples);
        EXPECT_LE(simulation.seconds, ideal + simulation.last_range) << ranks;
        EXPECT_LE(simulation.last_range, 2 * RangeQueue::shortest_range) << ranks;
        EXPECT_GT(crew.static_seconds(samples), 5 * ideal) << ranks;
        // Not many more messages than ranges of the longest time, and those of the end.
        const double least = ideal / RangeQueue::longest_range * static_cast<double>(ranks);
        EXPECT_LT(static_cast<double>(simulation.ranges), least + 40 * static_cast<double>(ranks))
            << ranks;
    }
}

/// One sample may take longer than the shortest range; nothing smaller can be handed out.
TEST(RangeQueue, EndsWithinOneSampleIfSamplesAreLong) {
    const Crew crew{{0.5, 0.05, 0.5}, {}, 0};
    const Simulation simulation = simulate(crew, {{0, 300}});
    EXPECT_LE(simulation.seconds, crew.ideal_seconds(300) + 20.0 + 1e-9);
    EXPECT_LT(simulation.seconds, 0.5 * crew.static_seconds(300));
}

/// The model of a large job: 200000 samples of 0.22 s each, speeds that differ by 5 %, one rank in
/// a hundred of half the speed, starts within 0.3 s of one second, 5 us to hand out a range.
Crew large_job(size_t ranks) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> deviation(-1, 1);
    Crew crew;
    crew.seconds_per_range = 5e-6;
    for (size_t rank = 0; rank < ranks; ++rank) {
        crew.rates.push_back((1 + 0.05 * deviation(random)) / 0.22 * (rank % 100 == 7 ? 0.5 : 1));
        crew.starts.push_back(1 + 0.3 * deviation(random));
    }
    return crew;
}

/// The efficiency counts the start as lost time. Beyond a thousand ranks, the start and single
/// samples are what limits it.
TEST(RangeQueue, KeepsManyRanksBusy) {
    for (const auto &[ranks, efficiency] :
         {std::pair<size_t, double>(64, 0.98), {1024, 0.95}, {4096, 0.80}}) {
        const Crew crew = large_job(ranks);
        constexpr uint64_t samples = 200000;
        const double ideal = crew.ideal_seconds(samples);
        EXPECT_GT(ideal / simulate(crew, {{0, samples}}).seconds, efficiency) << ranks;
        EXPECT_LT(ideal / crew.static_seconds(samples), 0.55) << ranks;
    }
}

TEST(RangeQueue, ShortensRangesBeforeAHorizon) {
    RangeQueue queue({{0, 1000000}}, 1);
    EXPECT_EQ(queue.next(0, forever)->count(), 1u);
    queue.note(0, 1, 0.01);
    EXPECT_EQ(queue.next(0, forever)->count(), 1400u);
    EXPECT_EQ(queue.next(0, 8.0)->count(), 200u);
    EXPECT_EQ(queue.next(0, 0.0)->count(), 10u);
}

}  // namespace
}  // namespace rtrays::cluster
