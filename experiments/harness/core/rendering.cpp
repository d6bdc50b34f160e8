// SPDX-License-Identifier: MIT
#include "experiments/harness/core/rendering.h"

namespace rtrays {

void compile_kernels(const Scene &scene, RenderSettings settings, DeviceContext &device) {
    if (settings.light_paths == LIGHT_PATHS_AUTO) {
        settings.light_paths = LIGHT_PATHS_LIKE_PIXELS;
    }
    RenderSession session(scene, settings, device);
    render_whole(session, 0, 1);
}

uint64_t batch_begin(const RenderSession &session, uint64_t first, uint64_t spp, uint64_t batches,
                     uint64_t batch) {
    if (session.settings().sampler == Sampler::sobol) {
        return first + batch * SOBOL_PERIOD;
    }
    return first + batch * spp / batches;
}

std::vector<Image> render_batches(RenderSession &session, uint32_t seed, uint64_t spp,
                                  uint64_t batches) {
    std::vector<Image> images;
    for (uint64_t batch = 0; batch < batches; ++batch) {
        session.restart(seed);
        const uint64_t begin = batch_begin(session, 0, spp, batches, batch);
        render_whole(session, begin, begin + (batch + 1) * spp / batches - batch * spp / batches);
        images.push_back(session.develop());
    }
    return images;
}

}  // namespace rtrays
