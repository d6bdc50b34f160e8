// SPDX-License-Identifier: MIT
// Stage generate_camera_rays: starts a camera path in every free slot while samples of the batch are left.
// Reads: free queue. Writes: path states. To: the active queue of this round.

#include "kernels/camera/perspective.h"
#include "kernels/sampling/random.h"
#include "kernels/stream.h"
#include "shared/integrator_settings.h"
#include "shared/path_state.h"
#include "shared/scene_buffers.h"

__kernel void generate_camera_rays(CameraRecord camera, IntegratorSettings settings, ulong first_sample, uint work,
                                   STREAM_PARAMETERS) {
    const uint i = get_global_id(0);
    if (i >= counters->free_slots) {
        return;
    }
    // Work items are samples of the batch, sample by sample, each over all pixels. `work` stays below 2^31 and at
    // most `capacity` work-items overshoot it, so the counter does not wrap.
    const uint item = atomic_inc(&counters->next_work);
    if (item >= work) {
        return;
    }
    const uint pixels = camera.width * camera.height;
    const uint pixel = item % pixels;
    const uint sample = item / pixels;
    const uint4 words = random_words(settings.seed, STREAM_CAMERA, pixel, first_sample + sample, BLOCK_CAMERA);
    const float x = (float)(pixel % camera.width) + uniform_float(words.x);
    const float y = (float)(pixel / camera.width) + uniform_float(words.y);

    const uint slot = queues[QUEUE_FREE * capacity + i];
    const PathStates paths = {path_words, capacity};
    set_pixel(paths, slot, pixel);
    set_sample(paths, slot, sample);
    set_depth(paths, slot, 0u);
    set_ray_origin(paths, slot, make_float3(camera.position[0], camera.position[1], camera.position[2]));
    set_ray_direction(paths, slot, camera_direction(camera, x, y));
    set_radiance(paths, slot, make_float3(0.0f, 0.0f, 0.0f));
#if FEATURE_scattering
    set_throughput(paths, slot, make_float3(1.0f, 1.0f, 1.0f));
#endif
    push_active(queues, counters, capacity, counters->parity, slot);
}
