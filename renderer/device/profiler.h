// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/device/opencl.h"

namespace rtrays {

/// Device time and number of launches by stage, read from OpenCL events.
class Profiler {
  public:
    struct Stage {
        double seconds = 0;  ///< between the start and the end of its launches on the device
        uint64_t launches = 0;
    };

    /// Takes over the event of one launch of `stage`.
    void add(const std::string &stage, ClEvent event) {
        pending_.emplace_back(&stages_[stage], std::move(event));
    }

    /// Books all events so far; they must have completed. Throws `Error` (run failed) when a launch
    /// had failed.
    void collect();

    const std::map<std::string, Stage> &stages() const { return stages_; }

    /// The stages booked so far, which start again from nothing: how users of one device keep
    /// accounts apart.
    std::map<std::string, Stage> take();

  private:
    std::map<std::string, Stage> stages_;  // nodes are stable: pending_ points into it
    std::vector<std::pair<Stage *, ClEvent>> pending_;
};

/// Device seconds of all stages together.
double total_seconds(const std::map<std::string, Profiler::Stage> &stages);

}  // namespace rtrays
