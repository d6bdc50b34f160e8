// SPDX-License-Identifier: MIT
#include "cluster/range_queue.h"

#include <algorithm>

namespace rtrays::cluster {

void RangeQueue::note(size_t rank, uint64_t samples, double seconds) {
    if (samples == 0) {
        return;
    }
    const double rate = static_cast<double>(samples) / std::max(seconds, 1e-9);
    known_ += rates_[rank] == 0 ? 1 : 0;
    known_sum_ += rate - rates_[rank];
    rates_[rank] = rate;
}

std::optional<SampleRange> RangeQueue::next(size_t rank, double horizon) {
    if (empty()) {
        return std::nullopt;
    }
    uint64_t left = 0;
    for (size_t i = first_; i < left_.size(); ++i) {
        left += left_[i].count();
    }
    uint64_t count = 1;
    if (rates_[rank] > 0) {
        const double time_left = static_cast<double>(left) / total_rate();
        const double seconds =
            std::clamp(std::min(horizon, time_left) / 4, shortest_range, longest_range);
        count = std::max<uint64_t>(1, static_cast<uint64_t>(rates_[rank] * seconds));
    }
    SampleRange &source = left_[first_];
    const SampleRange range{source.begin, source.begin + std::min(count, source.count())};
    source.begin = range.end;
    first_ += source.count() == 0 ? 1 : 0;
    return range;
}

double RangeQueue::total_rate() const {
    return known_ > 0
               ? known_sum_ / static_cast<double>(known_) * static_cast<double>(rates_.size())
               : 0;
}

}  // namespace rtrays::cluster
