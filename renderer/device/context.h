// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/device/opencl.h"
#include "renderer/device/profiler.h"

namespace rtrays {

/// What is known of an OpenCL device and decides defaults.
struct DeviceInfo {
    cl_platform_id platform;
    cl_device_id device;
    std::string name;
    std::string platform_name;
    std::string driver;     ///< driver version
    std::string c_version;  ///< "OpenCL C 1.2 PoCL"
    bool is_cpu;
    bool has_int64_atomics;  ///< cl_khr_int64_base_atomics
    bool rounds_division;  ///< divisions and square roots are correctly rounded where that is asked
                           ///< for
    uint32_t compute_units;
    uint64_t max_group_size;
    uint64_t max_allocation;  ///< bytes
    uint64_t global_memory;   ///< bytes
};

/// All devices of all platforms, platform by platform; platforms that cannot list their devices
/// have none.
std::vector<DeviceInfo> list_devices();

/// What becomes of a compiled program's binary.
enum class Binaries {
    keep,   ///< on disk: a later start takes 0.15 s instead of about one
    leave,  ///< to the driver, which may keep its own: PoCL compiles every kernel once more when
            ///< asked for the binary
};

/// One device with its context, an in-order profiling queue, and the account of what was launched
/// on it.
class DeviceContext {
  public:
    /// `spec`: "" (the first GPU, else the first device), "cpu", "gpu", "PLATFORM:DEVICE" by index,
    /// or a part of a device's name. Throws `Error` (bad usage) listing the devices when none
    /// matches, and naming the package to install when there is no device at all.
    explicit DeviceContext(const std::string &spec = "", Binaries binaries = Binaries::leave);

    const DeviceInfo &info() const { return info_; }
    Binaries binaries() const { return binaries_; }
    cl_context context() const { return context_.get(); }
    cl_command_queue queue() const { return queue_.get(); }
    Profiler &profiler() { return profiler_; }

    /// Waits until everything enqueued is done and books the events.
    void finish();

    /// Device memory that kernels read and write, uninitialized; throws `Error` (run failed) naming
    /// buffer and size when there is not so much of it.
    ClMemory allocate(const std::string &name, uint64_t bytes);

  private:
    DeviceInfo info_;
    Binaries binaries_;
    ClContext context_;
    ClQueue queue_;
    Profiler profiler_;
};

}  // namespace rtrays
