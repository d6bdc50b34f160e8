// SPDX-License-Identifier: MIT
// Describes the machine and measures how much CPU time other processes use during a measurement.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "renderer/base/json.h"
#include "renderer/device/context.h"

namespace rtrays {

/// Returns {"cpu", "cores", "kernel", "compiler", "build_type"}.
Json describe_host();

/// Returns the load averages of one, five and fifteen minutes.
Json load_average();

/// Returns the time in UTC: "2026-01-31T12:00:00Z".
std::string utc_now();

/// Shares of the total CPU time, in [0, 1] up to the granularity of ticks.
struct CpuUse {
    double own = 0;      ///< used by this process, all threads
    double foreign = 0;  ///< used by other processes
    double steal = 0;    ///< taken by the hypervisor
};

/// Measures CPU use since the last `start`, from /proc/stat and this process' CPU time. Throws
/// `Error` (run failed) if /proc/stat cannot be read.
class CpuMeter {
  public:
    CpuMeter() { start(); }
    void start();
    CpuUse use() const;

  private:
    struct Ticks {
        double total = 0, busy = 0, steal = 0, own = 0;  ///< CPU seconds
    };
    static Ticks read();

    Ticks start_;
};

/// Number of host threads for contestants that run on the host: a CPU device's compute units, or
/// all hardware threads if the device is a GPU.
uint32_t host_threads(const DeviceInfo &device);

/// Returns {"name", "type", "platform", "driver", "c_version", "compute_units"}.
Json describe_device(const DeviceInfo &device);

/// Records "context" of run.json: program, machine, device, and times and CPU load up to `finish`.
class RunContext {
  public:
    RunContext();
    Json finish(const DeviceInfo &device) const;

  private:
    std::string started_at_;
    Json load_average_;
    CpuMeter meter_;
};

}  // namespace rtrays
