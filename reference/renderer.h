// SPDX-License-Identifier: MIT
// ReferenceRenderer, the independent CPU path tracer that renders reference images.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "reference/first_hit.h"
#include "reference/settings.h"
#include "renderer/base/image.h"
#include "renderer/scene/stores.h"

namespace rtrays {

namespace reference {
struct Film;
}

/// Counts and times of one `ReferenceRenderer`.
struct ReferenceStats {
    std::string engine;  ///< name and version, as in "embree 3.13.5"
    uint64_t triangles = 0;
    uint64_t degenerate_triangles = 0;  ///< triangles of zero area, omitted
    double build_seconds = 0;           ///< time to build the BVH
    double seconds = 0;                 ///< wall time of `render`, including restored time
    uint64_t camera_rays = 0;           ///< equal to the number of paths; without restored samples
    uint64_t bounce_rays = 0;
    uint64_t shadow_rays = 0;
};

/// The independent path tracer. Embree computes visibility; everything else is implemented here in
/// double precision. It shares no BSDF, light, camera or random-number code with the renderer.
///
/// The bits of the film depend only on the scene, the settings (except `threads`) and the set of
/// samples, in whatever order and however split.
class ReferenceRenderer {
  public:
    /// Copies the required scene data. Throws `Error` (bad input) for a scene or settings that it
    /// cannot render.
    ReferenceRenderer(const SceneArrays &scene, const ReferenceSettings &settings);
    ~ReferenceRenderer();

    /// Adds the samples [begin, end) of every pixel to the film. Stops at the next batch once
    /// `interrupted()`. Returns the end of the rendered samples. Throws `Error` (bad input) if the
    /// film has some of the samples already. Throws `Error` (run failed) naming pixel, sample and
    /// number of such samples if the radiance of a path is not finite or not below
    /// `PixelSums::limit`; the film is then invalid.
    uint64_t render(uint64_t begin, uint64_t end);

    /// Returns a number of samples per pixel that takes a fraction of a second to render, a good
    /// step between checkpoints.
    uint64_t batch_size() const;

    /// Returns an image with the channels R, G, B, variance.R, variance.G, variance.B (variances of
    /// the mean) and samples, and the attributes samplesPerPixel and renderTimeSeconds.
    Image develop() const;

    /// Returns the class of every pixel, row by row from the top (first_hit_classifier.h). Does not
    /// change the film.
    std::vector<FirstHit> first_hits() const;

    double seconds() const;    ///< wall time spent in `render`, plus that of a restored film
    uint64_t samples() const;  ///< samples per pixel in the film
    ReferenceStats stats() const;

    const reference::Film &film() const;
    /// Continues a stored film. Throws `Error` (run failed) if its size differs from the settings.
    void restore(reference::Film film, double seconds);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace rtrays
