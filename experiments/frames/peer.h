// SPDX-License-Identifier: MIT
// Mitsuba 3 as a contestant: a process that renders when it is told to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "experiments/hierarchy/contest.h"
#include "renderer/base/process.h"

namespace rtrays {

/// `scripts/mitsuba_driver.py --serve`, run by the Python that `scripts/install --peers` makes.
class MitsubaPeer {
  public:
    /// Loads an exported scene (.xml) in `variant` ("scalar_rgb", "llvm_ad_rgb"); waits until it is there.
    /// Where Mitsuba or the variant is not installed, `is_there` is false.
    MitsubaPeer(const std::filesystem::path &scene, const std::string &variant);

    bool is_there() const { return !engine_.empty(); }
    const std::string &engine() const { return engine_; }  ///< "Mitsuba 3.9.1 scalar_rgb"

    /// One frame of path tracing without roulette, `max_depth` as ours, and what it took there. Throws
    /// `Error` (run failed) when the process ends.
    Seconds render(uint32_t max_depth, uint64_t spp);

  private:
    Process process_;
    std::string engine_;
    uint32_t seed_ = 0;
};

}  // namespace rtrays
