// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "reference/settings.h"
#include "renderer/base/image.h"
#include "renderer/scene/stores.h"

namespace rtrays {

namespace reference {
struct Film;
}

/// Counts and times of one `ReferenceRenderer`.
struct ReferenceStats {
    std::string engine;  ///< "embree 3.13.5"
    uint64_t triangles = 0;
    uint64_t degenerate_triangles = 0;  ///< of zero area, left out
    double build_seconds = 0;           ///< BVH
    double seconds = 0;                 ///< wall time of `render`, restored time included
    uint64_t camera_rays = 0;           ///< and so camera paths, of this object alone
    uint64_t bounce_rays = 0;
    uint64_t shadow_rays = 0;
};

/// The independent path tracer: Embree for visibility, everything else its own and in double
/// precision. It shares no BSDF, light, camera or random-number code with the renderer.
///
/// The film's bits depend on the scene, the settings (threads apart) and the sample range alone.
class ReferenceRenderer {
  public:
    /// Copies what it needs. Throws `Error` (bad input) for a scene it cannot render.
    ReferenceRenderer(const SceneArrays &scene, const ReferenceSettings &settings);
    ~ReferenceRenderer();

    /// Adds the samples [begin, end) of every pixel. `begin` must be the end of what the film holds
    /// already (anything while it is empty). Stops at the next batch once `interrupted()`; returns
    /// the end of what was rendered. Throws `Error` (run failed) naming pixel and sample when a
    /// path's radiance is not finite; the film is then void.
    uint64_t render(uint64_t begin, uint64_t end);

    /// Samples per pixel and call of `render` that take a fraction of a second: a good step between
    /// checkpoints.
    uint64_t batch_size() const;

    /// R, G, B, variance.R, .G, .B (of the mean), samples; attributes samplesPerPixel,
    /// renderTimeSeconds.
    Image develop() const;

    double seconds() const;    ///< wall time spent in `render`, plus that of a restored film
    uint64_t samples() const;  ///< per pixel, in the film
    ReferenceStats stats() const;

    const reference::Film &film() const;
    /// Continues a stored film; its size must be that of the settings (throws `Error`, run failed).
    void restore(reference::Film film, double seconds);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace rtrays
