// SPDX-License-Identifier: MIT
#include "experiments/harness/core/rendering.h"

#include "renderer/session/pilot.h"

namespace rtrays {

void compile_kernels(const Scene &scene, RenderSettings settings, DeviceContext &device) {
    if (needs_pilot(settings)) {
        RenderSession(scene, pilot_settings(settings), device);
    }
    if (trains_guide(settings)) {
        settings.guided_emission = GuidedEmission::flat;
    }
    if (settings.light_paths == LIGHT_PATHS_AUTO) {
        settings.light_paths = LIGHT_PATHS_LIKE_PIXELS;
    }
    RenderSession session(scene, settings, device);
    render_whole(session, 0, 1);
}

SampleRange batch_range(const RenderSession &session, uint64_t first, uint64_t spp,
                        uint64_t batches, uint64_t batch) {
    const uint64_t begin = batch * spp / batches, end = (batch + 1) * spp / batches;
    if (session.settings().sampler == Sampler::sobol) {
        const uint64_t begin_of_sequence = first + batch * SOBOL_PERIOD;
        return {begin_of_sequence, begin_of_sequence + end - begin};
    }
    return {first + begin, first + end};
}

std::vector<Image> render_batches(RenderSession &session, uint32_t seed, uint64_t spp,
                                  uint64_t batches) {
    std::vector<Image> images;
    for (uint64_t batch = 0; batch < batches; ++batch) {
        session.restart(seed);
        const SampleRange range = batch_range(session, 0, spp, batches, batch);
        render_whole(session, range.begin, range.end);
        images.push_back(session.develop());
    }
    return images;
}

}  // namespace rtrays
