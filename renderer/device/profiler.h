// SPDX-License-Identifier: MIT
// Device time and number of launches of every stage, measured with OpenCL events.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/device/opencl.h"

namespace rtrays {

/// Accumulates device time and number of launches by stage, read from OpenCL events.
class Profiler {
  public:
    struct Stage {
        /// Device time of its launches, each from its start to its end.
        double seconds = 0;
        uint64_t launches = 0;
    };

    /// Adds the event of one launch of `stage` and takes ownership of it.
    void add(const std::string &stage, ClEvent event) {
        pending_.emplace_back(&stages_[stage], std::move(event));
    }

    /// Adds the times of all pending events; they must have completed. Throws `Error` (run failed)
    /// when a launch has failed.
    void collect();

    const std::map<std::string, Stage> &stages() const { return stages_; }

    /// Returns the accumulated stages and resets them, so that several users of one device can keep
    /// separate profiles.
    std::map<std::string, Stage> take();

  private:
    std::map<std::string, Stage> stages_;  // nodes are stable: pending_ points to them
    std::vector<std::pair<Stage *, ClEvent>> pending_;
};

/// Returns the device seconds of all stages together.
double total_seconds(const std::map<std::string, Profiler::Stage> &stages);

}  // namespace rtrays
