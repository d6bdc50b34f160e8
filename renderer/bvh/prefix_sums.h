// SPDX-License-Identifier: MIT
#pragma once

#include <deque>

#include "renderer/device/buffer.h"
#include "renderer/device/kernel.h"

namespace rtrays {

/// Exclusive prefix sums on a device, modulo 2^32.
class PrefixSums {
  public:
    /// `block_size`: values per work-item, at least 2. Throws `Error` (bad input) for less.
    PrefixSums(DeviceContext &device, uint32_t group_size, uint32_t block_size);

    /// By the kind of device: a CPU core takes long blocks, a GPU wants many.
    static PrefixSums for_device(DeviceContext &device, uint32_t group_size);

    /// Enqueues replacing the first `count` of the values by the sum of those before each. With a
    /// last value of 0 that becomes the sum of all.
    void scan(const Buffer<uint32_t> &values, uint32_t count);

    uint64_t bytes() const;  ///< of device memory held, as much as the longest scan took

  private:
    void scan(const Buffer<uint32_t> &values, uint32_t count, size_t level);

    DeviceContext *device_;
    uint32_t block_size_;
    Kernel sum_blocks_, scan_blocks_;
    std::deque<Buffer<uint32_t>>
        sums_;  ///< of blocks, by level; references stay valid as levels are added
};

}  // namespace rtrays
