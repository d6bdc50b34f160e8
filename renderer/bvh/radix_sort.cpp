// SPDX-License-Identifier: MIT
#include "renderer/bvh/radix_sort.h"

namespace rtrays {

RadixSortParameters RadixSortParameters::for_device(const DeviceInfo &device, uint32_t group_size) {
    // A GPU keeps the counters of a work-item in or near its registers; a CPU keeps the counters of
    // 256 digits in its first-level cache.
    return device.is_cpu ? RadixSortParameters{group_size, 8, 16384}
                         : RadixSortParameters{group_size, 4, 32};
}

RadixSort::RadixSort(DeviceContext &device, const RadixSortParameters &parameters)
    : device_(&device),
      parameters_(parameters),
      sums_(PrefixSums::for_device(device, parameters.group_size)) {
    if (parameters.digit_bits < 1 || parameters.digit_bits > 8 || parameters.chunk_size == 0) {
        throw input_error(fmt::format(
            "radix sort: digits of {} bits and {} keys per work-item are out of range; use 1 to 8 "
            "bits and at least 1 key",
            parameters.digit_bits, parameters.chunk_size));
    }
    const Program program(device, {"kernels/bvh/radix_sort.cl"},
                          {{"RADIX_BITS", std::to_string(parameters.digit_bits)}});
    count_digits_ = Kernel(program, "count_digits", parameters.group_size);
    move_by_digit_ = Kernel(program, "move_by_digit", parameters.group_size);
}

uint32_t RadixSort::chunk_count(uint32_t count) const {
    return count / parameters_.chunk_size + (count % parameters_.chunk_size != 0 ? 1 : 0);
}

uint64_t RadixSort::bytes(uint32_t count) const {
    const uint64_t counts = uint64_t{chunk_count(count)} << parameters_.digit_bits;
    return uint64_t{count} * 12 + counts * sizeof(uint32_t) + sums_.bytes();
}

void RadixSort::sort(Buffer<uint64_t> &keys, Buffer<uint32_t> &values, uint32_t bits) {
    const auto count = static_cast<uint32_t>(keys.size());
    const uint32_t chunks = chunk_count(count), chunk_size = parameters_.chunk_size;
    const uint32_t digit_counts = chunks << parameters_.digit_bits;
    const Buffer<uint32_t> places(*device_, "sort places", digit_counts);
    Buffer<uint64_t> other_keys(*device_, keys.name(), count);
    Buffer<uint32_t> other_values(*device_, values.name(), count);
    for (uint32_t shift = 0; shift < bits; shift += parameters_.digit_bits) {
        count_digits_.bind({keys, count, shift, chunk_size, chunks, places});
        count_digits_.enqueue(chunks);
        sums_.scan(places, digit_counts);
        move_by_digit_.bind(
            {keys, values, count, shift, chunk_size, chunks, places, other_keys, other_values});
        move_by_digit_.enqueue(chunks);
        std::swap(keys, other_keys);
        std::swap(values, other_values);
    }
}

}  // namespace rtrays
