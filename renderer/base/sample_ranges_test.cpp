// SPDX-License-Identifier: MIT
#include "renderer/base/sample_ranges.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"

namespace rtrays {
namespace {

TEST(SampleRanges, JoinNeighboursInAnyOrder) {
    SampleRanges ranges;
    for (const SampleRange range : {SampleRange{8, 12}, {0, 2}, {5, 5}, {4, 8}, {2, 3}}) {
        add_range(ranges, range);
    }
    EXPECT_EQ(ranges, (SampleRanges{{0, 3}, {4, 12}}));
    EXPECT_EQ(count_samples(ranges), 11u);
    EXPECT_EQ(describe(ranges), "0:3 4:12");
}

TEST(SampleRanges, RefuseSamplesThatArePresent) {
    SampleRanges ranges{{4, 8}};
    for (const SampleRange range : {SampleRange{3, 5}, {7, 9}, {5, 6}, {0, 20}, {4, 8}}) {
        EXPECT_THROW(add_range(ranges, range), Error) << range.begin;
    }
    EXPECT_EQ(ranges, (SampleRanges{{4, 8}}));
}

/// Compares with a list of all samples, for every wanted range within [0, 16).
TEST(SampleRanges, MissWhatNoRangeHolds) {
    const SampleRanges ranges{{2, 5}, {6, 7}, {11, 14}};
    for (uint64_t begin = 0; begin < 16; ++begin) {
        for (uint64_t end = begin; end <= 16; ++end) {
            SampleRanges expected;
            for (uint64_t i = begin; i < end; ++i) {
                const bool present = (i >= 2 && i < 5) || i == 6 || (i >= 11 && i < 14);
                add_range(expected, {i, present ? i : i + 1});
            }
            EXPECT_EQ(missing_ranges(ranges, {begin, end}), expected) << begin << ':' << end;
        }
    }
}

}  // namespace
}  // namespace rtrays
