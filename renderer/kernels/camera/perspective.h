// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// The unit direction of the pinhole camera's ray through film position (x, y), in pixels from the top left
/// corner. A uniform position in a pixel has density p_v = 1 / pixel_area per area at unit distance (thesis
/// 2.46); with the box filter of one pixel the measured radiance has weight 1.
DEVICE float3 camera_direction(CameraRecord camera, float x, float y) {
    return normalize(make_float3(camera.corner[0] + x * camera.step_x[0] + y * camera.step_y[0],
                                 camera.corner[1] + x * camera.step_x[1] + y * camera.step_y[1],
                                 camera.corner[2] + x * camera.step_x[2] + y * camera.step_y[2]));
}
