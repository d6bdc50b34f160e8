// SPDX-License-Identifier: MIT
// OpenCL devices: discovery, selection, and the context and queue of one device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/device/opencl.h"
#include "renderer/device/profiler.h"

namespace rtrays {

/// Properties of an OpenCL device that identify it or decide default settings.
struct DeviceInfo {
    cl_platform_id platform;
    cl_device_id device;
    std::string name;
    std::string platform_name;
    std::string driver;     ///< driver version
    std::string c_version;  ///< "OpenCL C 1.2 PoCL"
    bool is_cpu;
    bool has_int64_atomics;  ///< cl_khr_int64_base_atomics
    /// Whether the device can round single-precision divisions and square roots correctly on
    /// request (a compiler option).
    bool rounds_division;
    uint32_t compute_units;
    uint64_t max_group_size;
    uint64_t max_allocation;  ///< bytes
    uint64_t global_memory;   ///< bytes
};

/// Returns all devices of all platforms, grouped by platform. Platforms that cannot list their
/// devices are skipped.
std::vector<DeviceInfo> list_devices();

/// Whether the binaries of compiled programs are kept.
enum class Binaries {
    /// On disk. A later start takes 0.15 s instead of about 1 s.
    keep,
    /// Left to the driver, which may have its own cache. This saves time: PoCL compiles every
    /// kernel for any group size when it is asked for the binary, and once more for the size of a
    /// launch. The first version alone would suffice (POCL_WORK_GROUP_SPECIALIZATION=0), but the
    /// wavefront is then 3 % slower.
    leave,
};

/// Commands that a program has enqueued on a device, and memory that it has allocated.
struct DeviceTraffic {
    uint64_t launches = 0;       ///< kernels
    uint64_t bytes_written = 0;  ///< copied from the host to buffers
    uint64_t bytes_read = 0;     ///< copied from buffers to the host
    uint64_t allocations = 0;    ///< buffers
};

/// One OpenCL device with its context, an in-order profiling queue, and the profile of all kernels
/// launched on it.
class DeviceContext {
  public:
    /// Opens the device that `spec` selects: "" (the first GPU, otherwise the first device), "cpu",
    /// "gpu", "PLATFORM:DEVICE" by index, or part of a device name. Throws `Error` (bad usage) that
    /// lists the devices when none matches, and that names the package to install when there is no
    /// device at all.
    explicit DeviceContext(const std::string &spec = "", Binaries binaries = Binaries::leave);

    const DeviceInfo &info() const { return info_; }
    Binaries binaries() const { return binaries_; }
    cl_context context() const { return context_.get(); }
    cl_command_queue queue() const { return queue_.get(); }
    Profiler &profiler() { return profiler_; }

    /// Counts of launches, copies and allocations, without the counters that a render polls.
    DeviceTraffic &traffic() { return traffic_; }

    /// Waits until all enqueued commands have completed, and adds their times to the profile.
    void finish();

    /// Allocates uninitialised device memory that kernels read and write. Throws `Error` (run
    /// failed) with the buffer's name and size when the device has too little memory.
    ClMemory allocate(const std::string &name, uint64_t bytes);

  private:
    DeviceInfo info_;
    Binaries binaries_;
    ClContext context_;
    ClQueue queue_;
    Profiler profiler_;
    DeviceTraffic traffic_;
};

}  // namespace rtrays
