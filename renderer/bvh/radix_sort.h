// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/bvh/prefix_sums.h"

namespace rtrays {

/// How sorting is spread over a device; changes no bit of the result.
struct RadixSortParameters {
    uint32_t group_size;  ///< work-items per work-group
    uint32_t digit_bits;  ///< of a key that one pass sorts by, 1 to 8
    uint32_t chunk_size;  ///< keys per work-item

    static RadixSortParameters for_device(const DeviceInfo &device, uint32_t group_size);
};

/// Sorts 64-bit keys with a value each on a device, stably.
class RadixSort {
  public:
    /// Throws `Error` (bad input) when a parameter is out of range.
    RadixSort(DeviceContext &device, const RadixSortParameters &parameters);

    /// Sorts by the lowest `bits` bits of the keys. Enqueues only; `bytes` says what memory that
    /// takes besides.
    void sort(Buffer<uint64_t> &keys, Buffer<uint32_t> &values, uint32_t bits);

    /// Of device memory that sorting so many keys takes besides the keys and values.
    uint64_t bytes(uint32_t count) const;

  private:
    uint32_t chunk_count(uint32_t count) const;

    DeviceContext *device_;
    RadixSortParameters parameters_;
    PrefixSums sums_;
    Kernel count_digits_, move_by_digit_;
};

}  // namespace rtrays
