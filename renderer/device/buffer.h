// SPDX-License-Identifier: MIT
// Typed arrays in device memory, with blocking copies to and from the host.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/device/context.h"

namespace rtrays {

/// Device array of `T`. Copies to and from the host are blocking. Every operation throws `Error`
/// (run failed) that names the buffer when the device refuses it.
template <typename T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>, "device records are plain data");

  public:
    Buffer() = default;

    /// Allocates `count` uninitialised items. PoCL's vectoriser may read past the end (pocl#757),
    /// hence 64 bytes of padding.
    Buffer(DeviceContext &device, std::string name, size_t count)
        : device_(&device), name_(std::move(name)), count_(count) {
        memory_ = device.allocate(name_, bytes() + padding);
    }

    Buffer(DeviceContext &device, std::string name, const std::vector<T> &values)
        : Buffer(device, std::move(name), values.size()) {
        write(values);
    }

    void write(const std::vector<T> &values) {
        if (values.size() != count_) {
            throw run_error(fmt::format("buffer '{}': expected {} items, got {}", name_, count_,
                                        values.size()));
        }
        write(0, values.data(), count_);
    }

    /// Writes `count` items from item `first` on.
    void write(size_t first, const T *values, size_t count) {
        if (count > count_ || first > count_ - count) {
            throw run_error(fmt::format("buffer '{}': items {} to {} are beyond its {} items",
                                        name_, first, first + count, count_));
        }
        if (count > 0) {
            check_cl(clEnqueueWriteBuffer(device_->queue(), get(), CL_TRUE, first * sizeof(T),
                                          count * sizeof(T), values, 0, nullptr, nullptr),
                     "writing buffer " + name_);
            device_->traffic().bytes_written += count * sizeof(T);
        }
    }

    void fill(const T &value) {
        if (count_ > 0) {
            check_cl(clEnqueueFillBuffer(device_->queue(), get(), &value, sizeof value, 0, bytes(),
                                         0, nullptr, nullptr),
                     "filling buffer " + name_);
        }
    }

    /// Sets all bytes to 0.
    void clear() {
        const uint8_t zero = 0;
        if (count_ > 0) {
            check_cl(clEnqueueFillBuffer(device_->queue(), get(), &zero, 1, 0, bytes(), 0, nullptr,
                                         nullptr),
                     "clearing buffer " + name_);
        }
    }

    std::vector<T> read() const {
        std::vector<T> values(count_);
        if (count_ > 0) {
            check_cl(clEnqueueReadBuffer(device_->queue(), get(), CL_TRUE, 0, bytes(),
                                         values.data(), 0, nullptr, nullptr),
                     "reading buffer " + name_);
            device_->traffic().bytes_read += bytes();
        }
        return values;
    }

    cl_mem get() const { return memory_.get(); }
    const std::string &name() const { return name_; }
    size_t size() const { return count_; }
    size_t bytes() const { return count_ * sizeof(T); }

  private:
    static constexpr size_t padding = 64;

    DeviceContext *device_ = nullptr;
    std::string name_;
    size_t count_ = 0;
    ClMemory memory_;
};

}  // namespace rtrays
