// SPDX-License-Identifier: MIT
// Prefix sums on a device, for numbering and sorting.
#pragma once

#include <deque>

#include "renderer/device/buffer.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Exclusive prefix sums on a device, modulo 2^32.
class PrefixSums {
  public:
    /// `block_size` is the number of values per work-item. Throws `Error` (bad input) if it is
    /// below 2.
    PrefixSums(DeviceContext &device, uint32_t group_size, uint32_t block_size);

    /// Chooses the block size by the type of device: long blocks for a CPU, many blocks for a GPU.
    static PrefixSums for_device(DeviceContext &device, uint32_t group_size);

    /// Enqueues the replacement of each of the first `count` values by the sum of the values before
    /// it. A last value of 0 is thus replaced by the sum of all.
    void scan(const Buffer<uint32_t> &values, uint32_t count);

    uint64_t bytes() const;  ///< device memory held, as large as the longest scan needed

  private:
    void scan(const Buffer<uint32_t> &values, uint32_t count, size_t level);

    DeviceContext *device_;
    uint32_t block_size_;
    Kernel sum_blocks_, scan_blocks_;
    /// Sums of blocks, by level. References stay valid as levels are added.
    std::deque<Buffer<uint32_t>> sums_;
};

}  // namespace rtrays
