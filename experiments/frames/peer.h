// SPDX-License-Identifier: MIT
// Another renderer as a contestant: a process that renders when it is told to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/hierarchy/contest.h"
#include "renderer/base/process.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// `scripts/*_driver.py --serve`, of Mitsuba 3 by the Python that `scripts/install --peers` makes,
/// or in Blender.
class Peer {
  public:
    /// "scalar_rgb" or "llvm_ad_rgb", variants of Mitsuba, or "cycles": exports the scene to
    /// `folder` and waits until it is loaded. Where the renderer or the variant is not installed,
    /// `is_there` is false.
    Peer(const Scene &scene, const std::filesystem::path &folder, const std::string &kind);

    bool is_there() const { return !engine_.empty(); }
    const std::string &engine() const { return engine_; }  ///< "Mitsuba 3.9.1 scalar_rgb"

    /// What the kind is called where it is not installed: "Mitsuba 3 scalar_rgb".
    static std::string name_of(const std::string &kind);

    /// One frame of path tracing without roulette, `max_depth` as ours, and what it took there.
    /// Throws `Error` (run failed) when the process ends.
    Seconds render(uint32_t max_depth, uint64_t spp);

  private:
    /// The next line of JSON; empty at the end of what the process says. Blender says other things,
    /// too.
    std::string next_record();

    Process process_;
    uint64_t frames_;  ///< rendered at once, where starting one costs something
    std::string engine_;
    uint32_t seed_ = 0;
};

}  // namespace rtrays
