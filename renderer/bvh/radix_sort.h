// SPDX-License-Identifier: MIT
// Radix sort of keys and values on a device.
#pragma once

#include "renderer/bvh/prefix_sums.h"

namespace rtrays {

/// How sorting is divided among work-items and passes. The parameters do not change a single bit of
/// the result.
struct RadixSortParameters {
    uint32_t group_size;  ///< work-items per work-group
    uint32_t digit_bits;  ///< bits of the key that one pass sorts by, 1 to 8
    uint32_t chunk_size;  ///< keys per work-item

    /// Returns the parameters that suit the type of device, CPU or GPU.
    static RadixSortParameters for_device(const DeviceInfo &device, uint32_t group_size);
};

/// Stable sort of 64-bit keys, each with a 32-bit value, on a device.
class RadixSort {
  public:
    /// Throws `Error` (bad input) when a parameter is out of range.
    RadixSort(DeviceContext &device, const RadixSortParameters &parameters);

    /// Enqueues sorting by the lowest `bits` bits of the keys. The device memory that it takes is
    /// reported by `bytes`.
    void sort(Buffer<uint64_t> &keys, Buffer<uint32_t> &values, uint32_t bits);

    /// Device memory in bytes that sorting `count` keys takes, without the keys and values.
    uint64_t bytes(uint32_t count) const;

  private:
    uint32_t chunk_count(uint32_t count) const;

    DeviceContext *device_;
    RadixSortParameters parameters_;
    PrefixSums sums_;
    Kernel count_digits_, move_by_digit_;
};

}  // namespace rtrays
