// SPDX-License-Identifier: MIT
#include "cluster/range_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rtrays::cluster {
namespace {

constexpr double forever = std::numeric_limits<double>::infinity();

/// Ranks of constant speed, in a world without a clock.
struct Crew {
    std::vector<double> rates;  ///< samples per second

    double ideal_seconds(uint64_t samples) const {
        return static_cast<double>(samples) / std::accumulate(rates.begin(), rates.end(), 0.0);
    }
    /// Returns when the last rank ends if all have equal parts.
    double static_seconds(uint64_t samples) const {
        return static_cast<double>(samples) / static_cast<double>(rates.size()) /
               *std::min_element(rates.begin(), rates.end());
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
    std::vector<double> free_at(ranks, 0), last(ranks, 0);
    std::vector<bool> done(ranks, false);
    while (std::find(done.begin(), done.end(), false) != done.end()) {
        size_t rank = ranks;
        for (size_t i = 0; i < ranks; ++i) {
            if (!done[i] && (rank == ranks || free_at[i] < free_at[rank])) {
                rank = i;
            }
        }
        const auto range = queue.next(rank, forever);
        if (!range) {
            done[rank] = true;
            continue;
        }
        last[rank] = static_cast<double>(range->count()) / crew.rates[rank];
        free_at[rank] += last[rank];
        queue.note(rank, range->count(), last[rank]);
        add_range(simulation.rendered, *range);
        ++simulation.ranges;
    }
    simulation.seconds = *std::max_element(free_at.begin(), free_at.end());
    simulation.last_range = *std::max_element(last.begin(), last.end());
    return simulation;
}

TEST(RangeQueue, HandsOutEverySampleOnce) {
    const SampleRanges missing{{3, 4}, {10, 500}, {501, 502}};
    EXPECT_EQ(simulate({{7.0, 100.0, 31.0}}, missing).rendered, missing);
    EXPECT_EQ(simulate({{1.0}}, missing).rendered, missing);
    EXPECT_TRUE(simulate({{1.0, 2.0}}, {}).rendered.empty());
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
    const Crew crew{{0.5, 0.05, 0.5}};
    const Simulation simulation = simulate(crew, {{0, 300}});
    EXPECT_LE(simulation.seconds, crew.ideal_seconds(300) + 20.0 + 1e-9);
    EXPECT_LT(simulation.seconds, 0.5 * crew.static_seconds(300));
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
