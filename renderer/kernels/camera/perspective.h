// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

typedef struct CameraRay {
    float3 origin;     ///< on the lens
    float3 direction;  ///< unit
} CameraRay;

/// The ray through film position (x, y), in pixels from the top left corner, and the point of the lens that (u, v)
/// stands for. A uniform position in a pixel has density p_v = 1 / pixel_area per area at unit distance, a uniform
/// point of the lens p_l = 1 / (pi r^2) per area (thesis 2.46); with the box filter of one pixel the measured radiance
/// has weight 1. Through a thin lens all rays of a film position meet where the one through the lens' centre, which
/// is not bent, crosses the plane in focus.
DEVICE CameraRay camera_ray(CameraRecord camera, float x, float y, float u, float v) {
    float3 way = make_float3(camera.corner[0] + x * camera.step_x[0] + y * camera.step_y[0],
                             camera.corner[1] + x * camera.step_x[1] + y * camera.step_y[1],
                             camera.corner[2] + x * camera.step_x[2] + y * camera.step_y[2]);
    CameraRay ray;
    ray.origin = make_float3(camera.position[0], camera.position[1], camera.position[2]);
#if FEATURE_lens
    const float2 disc = sample_disc(u, v);
    const float3 on_lens = (make_float3(camera.axis_x[0], camera.axis_x[1], camera.axis_x[2]) * disc.x +
                            make_float3(camera.axis_y[0], camera.axis_y[1], camera.axis_y[2]) * disc.y) *
                           camera.aperture_radius;
    ray.origin += on_lens;
    way = way * camera.focus_distance - on_lens;  // not 0: `way` has a component of 1 along the axis, the lens none
#endif
    ray.direction = normalize(way);
    return ray;
}
