// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <typeinfo>
#include <vector>

#include "renderer/device/buffer.h"
#include "renderer/device/program.h"

namespace rtrays {

/// One kernel argument: a buffer or a plain value, with its type for the check against the kernel.
class KernelArgument {
  public:
    template <typename T>
    KernelArgument(const Buffer<T> &buffer)  // NOLINT: arguments are listed in braces
        : type_(type_name(typeid(T)) + "*"), bytes_(sizeof(cl_mem)) {
        value_.memory = buffer.get();
    }
    KernelArgument(uint32_t value) : type_("uint"), bytes_(sizeof value) { value_.u32 = value; }
    KernelArgument(int32_t value) : type_("int"), bytes_(sizeof value) { value_.i32 = value; }
    KernelArgument(uint64_t value) : type_("ulong"), bytes_(sizeof value) { value_.u64 = value; }
    KernelArgument(float value) : type_("float"), bytes_(sizeof value) { value_.f32 = value; }

    const std::string &type() const { return type_; }
    size_t bytes() const { return bytes_; }
    const void *data() const { return &value_; }

    /// OpenCL's name of a C++ type: "uint" for unsigned int, "BvhNode" for a shared record.
    static std::string type_name(const std::type_info &type);

  private:
    std::string type_;
    size_t bytes_;
    union {
        cl_mem memory;
        uint32_t u32;
        int32_t i32;
        uint64_t u64;
        float f32;
    } value_{};
};

/// A kernel with a fixed work-group size. PoCL compiles a kernel at its first enqueue for each group size, so
/// the size belongs to the kernel and not to the launch.
class Kernel {
  public:
    Kernel() = default;

    /// Throws `Error` when the program has no kernel `name`.
    Kernel(const Program &program, const std::string &name, uint32_t group_size);

    /// Binds all arguments in order. Throws `Error` when their number or a type differs from the kernel's.
    void bind(const std::vector<KernelArgument> &arguments);

    /// Binds one argument that changes between launches, by position.
    void bind(uint32_t index, const KernelArgument &argument);

    /// Enqueues at least `items` work-items (rounded up to whole groups; kernels guard the rest). The launch
    /// is booked under the kernel's name. Zero items are not launched.
    void enqueue(uint64_t items);

    const std::string &name() const { return name_; }
    uint32_t group_size() const { return group_size_; }

  private:
    DeviceContext *device_ = nullptr;
    ClKernel kernel_;
    std::string name_;
    uint32_t group_size_ = 0;
    std::vector<std::string> types_;  ///< empty strings where the driver does not tell
};

}  // namespace rtrays
