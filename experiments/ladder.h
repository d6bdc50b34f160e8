// SPDX-License-Identifier: MIT
// Renders one curve: for each seed a ladder of sample counts on one session, resumable seed by
// seed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/description.h"
#include "experiments/document.h"
#include "renderer/base/error.h"
#include "renderer/device/context.h"
#include "renderer/pipeline/render_session.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// What a curve's ladders need.
struct LadderTask {
    const Scene &scene;
    DeviceContext &device;
    RenderSettings settings;    ///< with size
    std::vector<uint64_t> spp;  ///< the last one a multiple of `batches_per_seed`
    uint32_t seeds = 0;
    std::vector<uint64_t> early_images;  ///< rungs at which the first seed's image is kept
    const Image &reference;
    std::filesystem::path partial;          ///< folder of finished seeds
    std::function<void(uint64_t)> advance;  ///< told the samples per pixel of each finished rung
};

struct LadderResult {
    std::vector<Repetition> repetitions;
    std::vector<Image> images;  ///< of the seeds at the top rung
    std::vector<Image>
        batches;  ///< R, G, B of independent samples, `batches_per_seed` of equal size of each seed
    std::vector<Image> early_images;  ///< of the first seed, as the task names them
    nlohmann::json cost;              ///< {"compile_seconds", "bvh_seconds", "render_report"}
};

/// Finished seeds are read from `partial`, the others rendered and stored there. Throws `Error`
/// (interrupted) on SIGINT and SIGTERM.
LadderResult render_ladders(const LadderTask &task);

/// As many batches as the ladders have, each of twice the samples, of a seed that no ladder has.
std::vector<Image> render_fresh_batches(const LadderTask &task);

/// Renders the samples [begin, end), or throws `Error` (interrupted). `Renderer` is `RenderSession`
/// or `ReferenceRenderer`.
template <class Renderer>
void render_whole(Renderer &renderer, uint64_t begin, uint64_t end) {
    if (renderer.render(begin, end) < end) {
        throw Error(ExitCode::interrupted,
                    "interrupted; the same command again continues a run, or starts a gate anew");
    }
}

/// Renders a sample of each pixel, so that all kernels are in the cache, those for long paths too
/// where it meets some. Not by the pilot of `LIGHT_PATHS_AUTO`, which takes the same ones and its
/// time. Throws as above.
void compile_kernels(const Scene &scene, RenderSettings settings, DeviceContext &device);

/// Images of independent samples, [0, spp) in `batches` equal parts, by whose scatter variances are
/// told: splats of a path fall on several pixels, and rare bright paths show only so. The session
/// ends with the last of them. Throws as above.
std::vector<Image> render_batches(RenderSession &session, uint32_t seed, uint64_t spp,
                                  uint64_t batches);

}  // namespace rtrays
