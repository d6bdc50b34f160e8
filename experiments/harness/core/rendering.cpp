// SPDX-License-Identifier: MIT
#include "experiments/harness/core/rendering.h"

#include "renderer/compile/device_scene.h"
#include "renderer/session/pilot.h"

namespace rtrays {

void compile_kernels(const Scene &scene, RenderSettings settings, DeviceContext &device) {
    const auto shared = std::make_shared<DeviceScene>(
        scene, device_scene_settings(settings, device.info()), device);
    if (needs_pilot(settings)) {
        RenderSession(shared, scene, pilot_settings(settings));
    }
    if (trains_emission_guide(settings)) {
        settings.guided_emission = GuidedEmission::flat;
    }
    if (trains_scatter_guide(settings) && is_scatter_guidable(shared->compiled())) {
        settings.scatter_guide = std::make_shared<const ScatterGuide>(make_scatter_guide({}));
        RenderSession(shared, scene, pilot_settings(settings));
    }
    if (settings.light_paths == LIGHT_PATHS_AUTO) {
        settings.light_paths = LIGHT_PATHS_LIKE_PIXELS;
    }
    RenderSession session(shared, scene, settings);
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
