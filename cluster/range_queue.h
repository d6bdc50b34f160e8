// SPDX-License-Identifier: MIT
// Which rank renders which samples.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "renderer/base/sample_ranges.h"

namespace rtrays::cluster {

/// Hands out the samples of a render in ascending order, in ranges that become shorter towards the
/// end (guided self-scheduling: Polychronopoulos & Kuck 1987; weighted by the speed of a rank as in
/// Flynn Hummel et al. 1996). A rank gets what it renders in a quarter of the time that is left for
/// all ranks, so that all of them end at almost the same time, whatever their speeds.
class RangeQueue {
  public:
    static constexpr double shortest_range = 0.1;  ///< seconds; less would cost messages
    static constexpr double longest_range = 14.0;  ///< seconds; more would risk a late end

    RangeQueue(SampleRanges missing, size_t ranks)
        : left_(std::move(missing)), rates_(ranks), first_(0) {}

    /// Notes that a rank has rendered `samples` in `seconds`. Its last speed predicts the next one.
    void note(size_t rank, uint64_t samples, double seconds);

    /// Returns the next samples for a rank, or nothing if none are left. They take at most a
    /// quarter of `horizon` seconds, but at least `shortest_range`. A rank of unknown speed gets
    /// one sample.
    std::optional<SampleRange> next(size_t rank, double horizon);

    bool empty() const { return first_ == left_.size(); }

    /// Returns the speed of a rank in samples per second, 0 if it is unknown.
    double rate(size_t rank) const { return rates_[rank]; }
    /// Returns the sum of all speeds. A rank of unknown speed counts as the mean of the others.
    double total_rate() const;

  private:
    SampleRanges left_;
    std::vector<double> rates_;
    double known_sum_ = 0;  ///< of the speeds that are known
    size_t known_ = 0;
    size_t first_;  ///< of the ranges with samples left
};

}  // namespace rtrays::cluster
