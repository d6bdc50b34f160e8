// SPDX-License-Identifier: MIT
// OpenCL devices: discovery, selection, and the context and queue of one device.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
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

/// Returns whether a device is one of PoCL, which has its own cache of kernels.
bool is_pocl(const DeviceInfo &device);

/// Returns all devices of all platforms, grouped by platform. Platforms that cannot list their
/// devices are skipped.
std::vector<DeviceInfo> list_devices();

/// Returns "PLATFORM:DEVICE" of all devices that `spec` selects; `DeviceContext` opens the first.
/// Throws as its constructor does.
std::vector<std::string> matching_devices(const std::string &spec);

/// Whether the binaries of compiled programs are kept on disk.
enum class Binaries {
    keep,
    /// Kept unless the driver is PoCL, which has its own cache. Asked for a binary, PoCL compiles
    /// every kernel for any group size, and once more for the size of a launch: a first start then
    /// takes twice as long. The first version alone would suffice
    /// (POCL_WORK_GROUP_SPECIALIZATION=0), but the wavefront is then 3 % slower.
    by_driver,
};

/// A program that an OpenCL driver has built.
struct BuiltProgram {
    ClProgram program;
    size_t binary_bytes = 0;  ///< size of the binary, or 0 if it was not asked for
};

/// The programs that a context used last, by key, so that a session like an earlier one starts
/// without the compiler's front end.
class RecentPrograms {
  public:
    /// Returns the program of a key, or null.
    std::shared_ptr<const BuiltProgram> find(const std::string &key);
    void add(const std::string &key, std::shared_ptr<const BuiltProgram> program);

  private:
    static constexpr size_t capacity = 32;  ///< four or five sessions; each has a few MB

    struct Entry {
        std::string key;
        std::shared_ptr<const BuiltProgram> program;
    };
    std::list<Entry> entries_;  ///< the last used first
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
    explicit DeviceContext(const std::string &spec = "", Binaries binaries = Binaries::by_driver);

    const DeviceInfo &info() const { return info_; }
    /// Whether binaries of programs go to disk.
    bool keeps_binaries() const { return keeps_binaries_; }
    RecentPrograms &recent_programs() { return recent_programs_; }
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
    bool keeps_binaries_;
    ClContext context_;
    ClQueue queue_;
    Profiler profiler_;
    DeviceTraffic traffic_;
    RecentPrograms recent_programs_;
};

}  // namespace rtrays
