// SPDX-License-Identifier: MIT
// Renders what experiments need: full sample ranges, batches, and kernels for the cache.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/image.h"
#include "renderer/device/context.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {

/// Renders the samples [begin, end). Throws `Error` (interrupted) if a signal stops it. `Renderer`
/// is `RenderSession`, `ReferenceRenderer` or `PeerRenderer`.
template <class Renderer>
void render_whole(Renderer &renderer, uint64_t begin, uint64_t end) {
    if (renderer.render(begin, end) < end) {
        throw Error(ExitCode::interrupted,
                    "interrupted; repeat the command to continue a run or to restart a gate");
    }
}

/// Renders one sample per pixel, so that all kernels are compiled and cached. Kernels for long
/// paths are included if a path is long enough, and those of the pilot if there is one. What a
/// pilot chooses may need others. Throws `Error` (interrupted).
void compile_kernels(const Scene &scene, RenderSettings settings, DeviceContext &device);

/// Returns the samples of batch `batch`, of `batches` with `spp` samples together. Batches are
/// parts of one range, which begins at `first`. Batches of Sobol points would be too similar for
/// independent images; they are parts of different sequences instead.
SampleRange batch_range(const RenderSession &session, uint64_t first, uint64_t spp,
                        uint64_t batches, uint64_t batch);

/// Renders `spp` samples as `batches` independent images of equal parts. Variances are estimated
/// from the scatter of these images: splats of a path fall on several pixels, and only the scatter
/// shows rare bright paths. The session then has the last batch. Throws `Error` (interrupted).
std::vector<Image> render_batches(RenderSession &session, uint32_t seed, uint64_t spp,
                                  uint64_t batches);

}  // namespace rtrays
