// SPDX-License-Identifier: MIT
// The start of a camera path.
#pragma once

#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/sampling/word_batch.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/live_pixels.h"
#include "renderer/shared/path_state.h"

/// Pixel and sample of an item of a batch of `work` items. The samples of a pixel are consecutive
/// items, so that the pixel's film sums stay in a cache. Paths that are connected to light vertices
/// instead cover all pixels sample by sample, as light paths do.
typedef struct CameraItem {
    uint pixel, sample;
} CameraItem;

/// Returns pixel and sample of item `item`.
DEVICE CameraItem camera_item(LivePixels live, uint item, uint work) {
    CameraItem of;
    if (FEATURE_vertex_connections) {
        of.pixel = live_pixel(live, item % live.count);
        of.sample = item / live.count;
    } else {
        const uint samples = work / live.count;
        of.pixel = live_pixel(live, item / samples);
        of.sample = item % samples;
    }
    return of;
}

/// Requests the words of the camera paths from item `item` on.
DEVICE void request_camera_words(PRIVATE WordRequests *requests, LivePixels live, uint item,
                                 uint work) {
    for (uint i = 0u; i < WORD_BATCH; ++i) {
        const CameraItem of = camera_item(live, min(item + i, work - 1u), work);
        requests->pixel[i] = of.pixel;
        requests->sample[i] = of.sample;
        requests->block[i] = BLOCK_CAMERA;
    }
}

/// Starts the path of item `item` of the batch, by the words of BLOCK_CAMERA.
DEVICE void start_camera_path(Path path, CameraRecord camera, uint item, CameraItem of,
                              uint4 words) {
    uint column = of.pixel % camera.width, row = of.pixel / camera.width;
    if (FEATURE_crop) {
        column += camera.crop_x;
        row += camera.crop_y;
    }
    const float x = (float)column + uniform_float(words.x);
    const float y = (float)row + uniform_float(words.y);
    set_pixel(path, of.pixel);
    set_sample(path, of.sample);
    set_depth(path, 0u);
    const CameraRay ray = camera_ray(camera, x, y, uniform_float(words.z), uniform_float(words.w));
    set_ray_origin(path, ray.origin);
    set_ray_direction(path, ray.direction);
    set_radiance(path, make_float3(0.0f, 0.0f, 0.0f));
    set_throughput(path, make_float3(1.0f, 1.0f, 1.0f));
    set_pending(path, 0u);
    set_roulette_scale(path, 1.0f);
    if (FEATURE_light_strategy) {
        set_pdf_w(path, camera_pdf_w(camera, ray.direction));
    }
    set_log_strategies(path, -INFINITY);
    if (FEATURE_light_path_trials) {
        start_trials(path, item);
    }
}
