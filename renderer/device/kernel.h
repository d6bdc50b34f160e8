// SPDX-License-Identifier: MIT
// Kernels and their arguments, with a type check when an argument is bound.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include "renderer/device/buffer.h"
#include "renderer/device/program.h"

namespace rtrays {

/// One kernel argument: a buffer or a plain value (number or shared record). It carries the name of
/// its type, which is checked against the kernel.
class KernelArgument {
  public:
    template <typename T>
    KernelArgument(const Buffer<T> &buffer)  // implicit: arguments are listed in braces
        : type_(type_name(typeid(T)) + "*"), bytes_(to_bytes(buffer.get())) {}

    template <typename T>
    KernelArgument(const T &value) : type_(type_name(typeid(T))), bytes_(to_bytes(value)) {}

    const std::string &type() const { return type_; }
    const std::string &bytes() const { return bytes_; }

  private:
    /// Returns OpenCL's name of a C++ type: "uint" for unsigned int, "BvhNode" for a shared record.
    static std::string type_name(const std::type_info &type);

    template <typename T>
    static std::string to_bytes(const T &value) {
        static_assert(std::is_trivially_copyable_v<T>, "kernel arguments are plain data");
        return {reinterpret_cast<const char *>(&value), sizeof value};
    }

    std::string type_;
    std::string bytes_;
};

/// A kernel with a fixed work-group size. PoCL compiles a kernel at its first enqueue for each
/// group size, so the size belongs to the kernel and not to the launch.
class Kernel {
  public:
    Kernel() = default;

    /// Creates kernel `name` of `program` with `group_size` work-items per group. Throws `Error`
    /// (run failed) when the program has no such kernel.
    Kernel(const Program &program, const std::string &name, uint32_t group_size);

    /// Binds all arguments in order. Throws `Error` (run failed) when their number or a type
    /// differs from the kernel's.
    void bind(const std::vector<KernelArgument> &arguments);

    /// Binds one argument by position, for arguments that change between launches. Throws `Error`
    /// (run failed) when the position or the type is wrong.
    void bind(uint32_t index, const KernelArgument &argument);

    /// Throws `Error` (run failed) unless the kernel has `count` arguments.
    void require_argument_count(size_t count) const;

    /// Enqueues at least `items` work-items, rounded up to whole groups; kernels guard against the
    /// excess. The launch is recorded in the profile under the kernel's name. Nothing is launched
    /// for zero items.
    void enqueue(uint64_t items);

  private:
    DeviceContext *device_ = nullptr;
    ClKernel kernel_;
    std::string name_;
    uint32_t group_size_ = 0;
    std::vector<std::string> types_;  ///< empty strings if the driver does not report them
};

}  // namespace rtrays
