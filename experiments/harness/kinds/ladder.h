// SPDX-License-Identifier: MIT
// Renders one curve. Each seed is rendered to a ladder of increasing sample counts in one session;
// an interrupted curve is resumed seed by seed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/harness/core/description.h"
#include "experiments/harness/core/document.h"
#include "renderer/base/error.h"
#include "renderer/device/context.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {

/// Inputs of a curve's ladders.
struct LadderTask {
    const Scene &scene;
    DeviceContext &device;
    RenderSettings settings;    ///< including the size
    std::vector<uint64_t> spp;  ///< increasing; the last is a multiple of `batches_per_seed`
    uint32_t seeds = 0;
    std::vector<uint64_t> early_images;  ///< sample counts at which the first seed's image is kept
    const Image &reference;
    std::filesystem::path partial;          ///< folder of finished seeds
    std::function<void(uint64_t)> advance;  ///< called with the newly finished samples per pixel
};

struct LadderResult {
    std::vector<Repetition> repetitions;
    std::vector<Image> images;  ///< image of each seed at the largest sample count
    /// R, G, B of independent samples: `batches_per_seed` batches of equal size from each seed.
    std::vector<Image> batches;
    std::vector<Image> early_images;  ///< images of the first seed at `LadderTask::early_images`
    nlohmann::json cost;              ///< {"compile_seconds", "bvh_seconds", "render_report"}
};

/// Renders the ladders of all seeds. Finished seeds are read from `partial`; the others are
/// rendered and stored there. Throws `Error` (interrupted) on SIGINT and SIGTERM.
LadderResult render_ladders(const LadderTask &task);

/// Renders as many batches as the ladders have, each with twice the samples. They use a seed that
/// no ladder uses.
std::vector<Image> render_fresh_batches(const LadderTask &task);

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
/// paths are included if a path is long enough. The pilot of `LIGHT_PATHS_AUTO` is skipped, because
/// it uses the same kernels and takes time. Throws `Error` (interrupted).
void compile_kernels(const Scene &scene, RenderSettings settings, DeviceContext &device);

/// Renders the samples [0, spp) as `batches` images of equal parts. Variances are estimated from
/// the scatter of these images: splats of a path fall on several pixels, and only the scatter shows
/// rare bright paths. The session then has the last batch. Throws `Error` (interrupted).
std::vector<Image> render_batches(RenderSession &session, uint32_t seed, uint64_t spp,
                                  uint64_t batches);

}  // namespace rtrays
