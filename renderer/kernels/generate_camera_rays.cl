// SPDX-License-Identifier: MIT
// Stage generate_camera_rays: starts a camera path in every free slot while samples of the batch
// are left.
//
// Reads: free queue, list of live pixels.
// Writes: path states.
// Enqueues: active queue of this round.

#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/stream.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/live_pixels.h"
#include "renderer/shared/path_state.h"

/// Starts sample `sample` of the batch in pixel `pixel`.
DEVICE void start_path(PathStates paths, uint slot, CameraRecord camera,
                       IntegratorSettings settings, ulong first_sample, uint pixel, uint sample) {
    const uint4 words = path_sample(settings, pixel, first_sample + sample, BLOCK_CAMERA);
    const float x = (float)(pixel % camera.width) + uniform_float(words.x);
    const float y = (float)(pixel / camera.width) + uniform_float(words.y);
    set_pixel(paths, slot, pixel);
    set_sample(paths, slot, sample);
    set_depth(paths, slot, 0u);
    const CameraRay ray = camera_ray(camera, x, y, uniform_float(words.z), uniform_float(words.w));
    set_ray_origin(paths, slot, ray.origin);
    set_ray_direction(paths, slot, ray.direction);
    set_radiance(paths, slot, make_float3(0.0f, 0.0f, 0.0f));
    set_throughput(paths, slot, make_float3(1.0f, 1.0f, 1.0f));
    set_pending(paths, slot, 0u);
    set_roulette_scale(paths, slot, 1.0f);
    if (FEATURE_light_strategy) {
        set_pdf_w(paths, slot, camera_pdf_w(camera, ray.direction));
    }
    set_log_strategies(paths, slot, -INFINITY);
}

/// Starts item `item` of a batch of `work` items. The samples of a pixel are consecutive items, so
/// that the pixel's film sums stay in a cache. Paths that are connected to light vertices instead
/// cover all pixels sample by sample, as light paths do.
DEVICE void start_item(PathStates paths, uint slot, CameraRecord camera,
                       IntegratorSettings settings, ulong first_sample, LivePixels live, uint item,
                       uint work) {
    uint pixel, sample;
    if (FEATURE_vertex_joins) {
        pixel = item % live.count;
        sample = item / live.count;
    } else {
        const uint samples = work / live.count;
        pixel = item / samples;
        sample = item % samples;
    }
    start_path(paths, slot, camera, settings, first_sample, live_pixel(live, pixel), sample);
}

#if !PATH_STATES_PRIVATE

__kernel void generate_camera_rays(CameraRecord camera, IntegratorSettings settings,
                                   ulong first_sample, uint work, GLOBAL const uint *live_pixels,
                                   uint live_count, STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    const LivePixels live = make_live_pixels(live_pixels, live_count, camera.width * camera.height);
    const WorkItems items = take_work(counters);
    PushBuffer started;
    started.count = 0u;
    for (uint i = 0; i < items.count && items.first + i < work; ++i) {
        const uint slot = queues[QUEUE_FREE * capacity + items.slots + i];
        start_item(paths, slot, camera, settings, first_sample, live, items.first + i, work);
        push_slot(&started, slot);
    }
    append_active(queues, counters, capacity, counters->parity, &started);
}

#endif
