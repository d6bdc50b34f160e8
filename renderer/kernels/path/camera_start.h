// SPDX-License-Identifier: MIT
// The start of a camera path.
#pragma once

#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/live_pixels.h"
#include "renderer/shared/path_state.h"

/// Starts sample `sample` of the batch in pixel `pixel`.
DEVICE void start_camera_path(Path path, CameraRecord camera, IntegratorSettings settings,
                              ulong first_sample, uint pixel, uint sample) {
    const uint4 words = path_sample(settings, pixel, first_sample + sample, BLOCK_CAMERA);
    uint column = pixel % camera.width, row = pixel / camera.width;
    if (FEATURE_crop) {
        column += camera.crop_x;
        row += camera.crop_y;
    }
    const float x = (float)column + uniform_float(words.x);
    const float y = (float)row + uniform_float(words.y);
    set_pixel(path, pixel);
    set_sample(path, sample);
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
}

/// Starts item `item` of a batch of `work` items. The samples of a pixel are consecutive items, so
/// that the pixel's film sums stay in a cache. Paths that are connected to light vertices instead
/// cover all pixels sample by sample, as light paths do.
DEVICE void start_camera_item(Path path, CameraRecord camera, IntegratorSettings settings,
                              ulong first_sample, LivePixels live, uint item, uint work) {
    uint pixel, sample;
    if (FEATURE_vertex_connections) {
        pixel = item % live.count;
        sample = item / live.count;
    } else {
        const uint samples = work / live.count;
        pixel = item / samples;
        sample = item % samples;
    }
    start_camera_path(path, camera, settings, first_sample, live_pixel(live, pixel), sample);
    if (FEATURE_light_path_trials) {
        start_trials(path, item);
    }
}
