// SPDX-License-Identifier: MIT
// What the machine is, and how much of it others use while we measure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "renderer/base/json.h"
#include "renderer/device/context.h"

namespace rtrays {

/// {"cpu", "cores", "kernel", "compiler", "build_type"}.
Json describe_host();

/// One, five and fifteen minute load averages.
Json load_average();

/// "2026-01-31T12:00:00Z".
std::string utc_now();

/// Shares of all CPU time since the last `start`, in [0, 1] up to the granularity of ticks.
struct CpuUse {
    double own = 0;      ///< this process, all threads
    double foreign = 0;  ///< other processes
    double steal = 0;    ///< taken by the hypervisor
};

/// Reads /proc/stat and this process' CPU time; throws `Error` (run failed) where there is no
/// /proc/stat.
class CpuMeter {
  public:
    CpuMeter() { start(); }
    void start();
    CpuUse use() const;

  private:
    struct Ticks {
        double total = 0, busy = 0, steal = 0, own = 0;  ///< seconds of CPU
    };
    static Ticks read();

    Ticks start_;
};

/// Threads of what runs on the host beside a device: as many as a CPU has compute units, all beside
/// a GPU.
uint32_t host_threads(const DeviceInfo &device);

/// {"name", "type", "platform", "driver", "c_version", "compute_units"}.
Json describe_device(const DeviceInfo &device);

/// "context" of run.json: what ran where, when and beside what else, from construction to `finish`.
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
