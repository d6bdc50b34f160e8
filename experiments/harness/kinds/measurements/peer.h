// SPDX-License-Identifier: MIT
// Another renderer as a contestant: a separate process that renders on request.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/harness/core/contest.h"
#include "renderer/base/process.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// A frame of path tracing.
struct PeerFrame {
    uint32_t max_depth = 0;  ///< with RTRays' meaning; 0: no limit
    uint64_t spp = 1;
    /// Scattering event from which Mitsuba's roulette may end a path; 0: no roulette. Cycles only
    /// has its own roulette, for any number but 0.
    uint32_t roulette = 0;
    std::filesystem::path image{};  ///< EXR file to write outside of the duration; empty: none
    uint32_t seed = 0;              ///< 0: one that no frame had before
};

/// Process of `scripts/rtrays/peers/*_driver.py --serve`. Mitsuba 3 runs in the Python environment
/// that `scripts/install --peers` creates; Cycles runs in Blender.
class Peer {
  public:
    /// Exports the scene to `folder`, starts the renderer and waits until it has loaded the scene.
    /// `kind` is a variant of Mitsuba ("scalar_rgb" or "llvm_ad_rgb") or "cycles". `is_there` is
    /// false if the renderer or the variant is not installed.
    Peer(const Scene &scene, const std::filesystem::path &folder, const std::string &kind);

    bool is_there() const { return !engine_.empty(); }
    const std::string &engine() const { return engine_; }  ///< "Mitsuba 3.9.1 scalar_rgb"

    /// Returns the name of a kind that need not be installed: "Mitsuba 3 scalar_rgb".
    static std::string name_of(const std::string &kind);

    /// Renders one frame of path tracing and returns its duration, measured in the process. Throws
    /// `Error` (run failed) if the process ends.
    Seconds render(const PeerFrame &frame);

  private:
    /// Returns the next line of JSON, or an empty text when the output ends. Other lines are
    /// skipped, because Blender prints its own.
    std::string next_record();

    Process process_;
    uint64_t frames_;  ///< frames in one call, more than one if a call has an overhead
    std::string engine_;
    uint32_t seed_ = 0;
};

}  // namespace rtrays
