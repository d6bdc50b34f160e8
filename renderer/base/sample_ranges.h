// SPDX-License-Identifier: MIT
// Ranges of sample indices: which samples a film holds, and which it lacks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rtrays {

/// Half-open range of sample indices.
struct SampleRange {
    uint64_t begin;
    uint64_t end;

    uint64_t count() const { return end - begin; }
    bool operator==(const SampleRange &other) const {
        return begin == other.begin && end == other.end;
    }
};

/// Ranges in ascending order that neither overlap nor touch.
using SampleRanges = std::vector<SampleRange>;

/// Returns the number of samples in all ranges.
uint64_t count_samples(const SampleRanges &ranges);

/// Adds a range, which may be empty. Throws `Error` (bad input) when it overlaps a present one;
/// `ranges` then stays.
void add_range(SampleRanges &ranges, SampleRange range);

/// Returns the parts of `wanted` that are in none of the ranges.
SampleRanges missing_ranges(const SampleRanges &ranges, SampleRange wanted);

/// Returns the ranges as text: "0:64 128:256".
std::string describe(const SampleRanges &ranges);

}  // namespace rtrays
