// SPDX-License-Identifier: MIT
// Stage generate_camera_rays: starts a camera path in every free slot while samples of the batch
// are left.
//
// STAGE(generate_camera_rays,
//       reads(free, live_pixels),
//       writes(pixel, sample, depth, ray_origin, ray_direction, throughput, roulette_scale,
//              radiance, pdf_w, log_strategies, pending, trials),
//       to(active))

#include "renderer/kernels/path/camera_start.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/stream.h"

__kernel void generate_camera_rays(CameraRecord camera, IntegratorSettings settings,
                                   ulong first_sample, uint work, GLOBAL const uint *live_pixels,
                                   uint live_count, STREAM_PARAMETERS) {
    const Stream stream = STREAM_VIEW;
    const LivePixels live = make_live_pixels(live_pixels, live_count, camera.width * camera.height);
    const WorkItems items = take_work(stream);
    WordRequests requests;
    WordBatch words;
    PushBuffer started;
    started.count = 0u;
    for (uint i = 0; i < items.count && items.first + i < work; ++i) {
        const Path path = path_in(stream, queue_entries(stream, QUEUE_FREE)[items.slots + i]);
        const uint item = items.first + i, place = i % WORD_BATCH;
        if (place == 0u) {
            request_camera_words(&requests, live, item, work);
            draw_words(&words, &requests, settings, STREAM_CAMERA, first_sample);
        }
        const CameraItem of = {requests.pixel[place], requests.sample[place]};
        start_camera_path(path, camera, item, of, words_in(&words, place));
        push_slot(&started, path.slot);
    }
    append_started(stream, &started);
}
