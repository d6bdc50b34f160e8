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

std::vector<Image> render_batches(RenderSession &session, uint32_t seed, uint64_t spp,
                                  uint64_t batches) {
    std::vector<Image> images;
    for (uint64_t batch = 0; batch < batches; ++batch) {
        session.restart(seed);
        render_whole(session, batch * spp / batches, (batch + 1) * spp / batches);
        images.push_back(session.develop());
    }
    return images;
}

}  // namespace rtrays
