// SPDX-License-Identifier: MIT
// Where the images of a curve come from: a session of this renderer, or another renderer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/harness/core/description.h"
#include "renderer/base/image.h"
#include "renderer/session/shared_scenes.h"

namespace rtrays {

/// An image and the seconds of all its samples.
struct TimedImage {
    Image image;
    double seconds_device = 0;
    double seconds_wall = 0;
};

/// Renders the images of a curve.
class CurveSource {
  public:
    virtual ~CurveSource() = default;

    /// Begins the images of a seed.
    virtual void restart(uint32_t seed) = 0;

    /// Returns an image of `spp` samples per pixel, more than in the last image of this seed.
    /// Throws `Error` (interrupted, or run failed).
    virtual TimedImage render_to(uint64_t spp) = 0;

    /// Returns `count` independent images of equally many samples, `spp` per pixel together. Their
    /// seeds begin at `seed`.
    virtual std::vector<Image> independent_images(uint32_t seed, uint64_t spp, uint64_t count) = 0;

    /// Returns what the document of a curve has besides its errors: what was rendered how, and the
    /// times and bytes that its points do not have.
    virtual nlohmann::json description() const = 0;
};

/// Renders with a session over a shared scene. An image of a seed contains the samples of the
/// earlier ones.
std::unique_ptr<CurveSource> session_source(SharedScenes &scenes, const RenderSettings &settings);

/// Renders with another renderer. Every image has its own samples, and its seconds are those that
/// the renderer reports, or those of its process. Mitsuba and Cycles render the exported scene of
/// `scene_file`, of the size and `max_depth` of `settings`. They compile in an image of each number
/// of samples that does not count; a command renders one such image. Files are in `folder`, which
/// is created, and deleted at the end. Throws `Error` (skipped, exit code 77) if Mitsuba or Cycles
/// is not installed.
std::unique_ptr<CurveSource> other_source(const CurveDescription &curve,
                                          const std::filesystem::path &scene_file,
                                          const RenderSettings &settings,
                                          const std::filesystem::path &folder);

}  // namespace rtrays
