// SPDX-License-Identifier: MIT
#include "renderer/base/sample_ranges.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"

namespace rtrays {

uint64_t count_samples(const SampleRanges &ranges) {
    uint64_t count = 0;
    for (const SampleRange &range : ranges) {
        count += range.count();
    }
    return count;
}

void add_range(SampleRanges &ranges, SampleRange range) {
    if (range.begin == range.end) {
        return;
    }
    for (const SampleRange &present : ranges) {
        if (range.begin < present.end && present.begin < range.end) {
            throw input_error(fmt::format(
                "samples {}:{} overlap {}:{}, which are in the film already; render others",
                range.begin, range.end, present.begin, present.end));
        }
    }
    ranges.push_back(range);
    std::sort(ranges.begin(), ranges.end(),
              [](const SampleRange &a, const SampleRange &b) { return a.begin < b.begin; });
    SampleRanges merged;
    for (const SampleRange &r : ranges) {
        if (!merged.empty() && merged.back().end == r.begin) {
            merged.back().end = r.end;
        } else {
            merged.push_back(r);
        }
    }
    ranges = merged;
}

SampleRanges missing_ranges(const SampleRanges &ranges, SampleRange wanted) {
    SampleRanges missing;
    for (const SampleRange &present : ranges) {
        if (wanted.begin < std::min(present.begin, wanted.end)) {
            missing.push_back({wanted.begin, std::min(present.begin, wanted.end)});
        }
        wanted.begin = std::max(wanted.begin, present.end);
    }
    if (wanted.begin < wanted.end) {
        missing.push_back(wanted);
    }
    return missing;
}

std::string describe(const SampleRanges &ranges) {
    std::string text;
    for (const SampleRange &range : ranges) {
        text += fmt::format("{}{}:{}", text.empty() ? "" : " ", range.begin, range.end);
    }
    return text;
}

}  // namespace rtrays
