// SPDX-License-Identifier: MIT
// Tests of contests: the order of the turns, and the speeds computed from them.
#include "experiments/harness/core/contest.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "renderer/base/error.h"

namespace rtrays {
namespace {

TEST(Contest, TakesTurnsThereAndBack) {
    std::string order;
    Contest contest;
    for (const char *name : {"a", "b", "c"}) {
        contest.add(name, [&, name] {
            order += name;
            return Seconds{1, 1};
        });
    }
    for (int turn = 0; turn < 3; ++turn) {
        contest.turn();
    }
    EXPECT_EQ(order, "abccbaabc");
    EXPECT_EQ(contest.turns(), 3u);
    EXPECT_EQ(contest.names(), (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_THROW(contest.wall_seconds("a"), Error) << "three turns have no 95 % interval";
    EXPECT_THROW(contest.wall_seconds("d"), std::out_of_range);
}

TEST(Contest, DiscardedTurnsLeaveNoTimes) {
    int calls = 0, runs = 0;
    Contest contest(Clock::wall, [&] { return ++calls % 2 == 0 ? 0.01 * calls : 9; });
    contest.add("a", [&] { return Seconds{1.0 * ++runs, 0}; });
    for (int turn = 0; turn < 7; ++turn) {
        contest.turn();
        if (turn == 3) {
            EXPECT_EQ(contest.last_seconds("a").wall, 4);
            EXPECT_NEAR(contest.last_foreign_load(), 0.08, 1e-12);
            contest.discard_turn();
        }
    }
    EXPECT_EQ(contest.turns(), 6u);
    EXPECT_EQ(contest.wall_seconds("a").value, 4);  // of 1, 2, 3, 5, 6, 7
    EXPECT_NEAR(contest.foreign_load(), 0.08, 1e-12);
}

TEST(Contest, SpeedsAreRatiosWithinATurn) {
    // Both are slowed by the number of the turn, so the times spread and the ratio is constant.
    Contest contest;
    int slow = 0, fast = 0;
    contest.add("slow", [&] { return Seconds{8.0 * ++slow, 4.0 * slow}; });
    contest.add("fast", [&] { return Seconds{3.0 * ++fast, 1.0 * fast}; });
    for (int turn = 0; turn < 9; ++turn) {
        contest.turn();
    }
    const Interval speed = contest.speed_over("fast", "slow");
    EXPECT_EQ(speed.value, 4);
    EXPECT_EQ(speed.low, 4);
    EXPECT_EQ(speed.high, 4);
    EXPECT_EQ(contest.speed_over("slow", "fast").value, 0.25);
    EXPECT_EQ(contest.wall_seconds("slow").value, 40);
    EXPECT_EQ(contest.processor_seconds("fast").value, 5);
    EXPECT_LT(contest.processor_seconds("fast").low, 3);
    EXPECT_GE(contest.foreign_load(), 0);
    EXPECT_LE(contest.foreign_load(), 1);
}

}  // namespace
}  // namespace rtrays
