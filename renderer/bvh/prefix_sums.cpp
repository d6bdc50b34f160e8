// SPDX-License-Identifier: MIT
#include "renderer/bvh/prefix_sums.h"

#include <numeric>

namespace rtrays {

PrefixSums::PrefixSums(DeviceContext &device, uint32_t group_size, uint32_t block_size)
    : device_(&device), block_size_(block_size) {
    if (block_size < 2) {
        throw input_error(fmt::format(
            "prefix sums: block size {} is too small; use at least 2 values", block_size));
    }
    const Program program(device, {"kernels/bvh/prefix_sums.cl"});
    sum_blocks_ = Kernel(program, "sum_blocks", group_size);
    scan_blocks_ = Kernel(program, "scan_blocks", group_size);
}

PrefixSums PrefixSums::for_device(DeviceContext &device, uint32_t group_size) {
    return {device, group_size, device.info().is_cpu ? 4096u : 64u};
}

void PrefixSums::scan(const Buffer<uint32_t> &values, uint32_t count) {
    scan(values, count, 0);
}

void PrefixSums::scan(const Buffer<uint32_t> &values, uint32_t count, size_t level) {
    const uint32_t blocks = (count + block_size_ - 1) / block_size_;
    if (sums_.size() == level) {
        sums_.emplace_back(*device_, "prefix sums", 0);
    }
    if (blocks > 1) {
        if (sums_[level].size() < blocks) {
            sums_[level] = Buffer<uint32_t>(*device_, "prefix sums", blocks);
        }
        sum_blocks_.bind({values, count, block_size_, sums_[level]});
        sum_blocks_.enqueue(blocks);
        scan(sums_[level], blocks, level + 1);
    }
    scan_blocks_.bind({values, count, block_size_, sums_[level]});
    scan_blocks_.enqueue(blocks);
}

uint64_t PrefixSums::bytes() const {
    return std::accumulate(
        sums_.begin(), sums_.end(), uint64_t{0},
        [](uint64_t sum, const Buffer<uint32_t> &buffer) { return sum + buffer.bytes(); });
}

}  // namespace rtrays
