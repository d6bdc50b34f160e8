// SPDX-License-Identifier: MIT
// What all cameras share: rays, connections, and positions on the film.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// A camera ray.
typedef struct CameraRay {
    float3 origin;
    float3 direction;  ///< unit
} CameraRay;

/// A connection of a scene point to the camera.
typedef struct CameraConnection {
    float3 lens_point;
    float2 raster;  ///< film position in pixels from the top left corner; valid if pdf_w is not 0
    float pdf_w;  ///< `camera_pdf_w` of the ray to the point; 0 behind the lens or outside the film
} CameraConnection;

/// Returns the unit viewing direction. The scene rejects cameras that mirror, so up x right points
/// forward.
DEVICE float3 camera_forward(CameraRecord camera) {
    return cross(make_float3(camera.axis_y[0], camera.axis_y[1], camera.axis_y[2]),
                 make_float3(camera.axis_x[0], camera.axis_x[1], camera.axis_x[2]));
}

/// Sets the film position of a vector from the centre of the full picture, on the plane where a
/// pixel has `pixel_area`. A component along the axis has no effect. Returns whether it is on the
/// film; overflow and NaN are not.
DEVICE bool set_raster(CameraRecord camera, float3 seen, PRIVATE float2 *raster) {
    const float3 step_x = make_float3(camera.step_x[0], camera.step_x[1], camera.step_x[2]);
    const float3 step_y = make_float3(camera.step_y[0], camera.step_y[1], camera.step_y[2]);
    const float width = (float)camera.width, height = (float)camera.height;
    // The steps have the length of a pixel, so a division by its area gives pixels.
    const float across = dot(seen, step_x) / camera.pixel_area;
    const float down = dot(seen, step_y) / camera.pixel_area;
    if (FEATURE_crop) {
        *raster = make_float2(0.5f * (float)camera.full_width + across - (float)camera.crop_x,
                              0.5f * (float)camera.full_height + down - (float)camera.crop_y);
    } else {
        *raster = make_float2(0.5f * width + across, 0.5f * height + down);
    }
    return raster->x >= 0.0f && raster->x < width && raster->y >= 0.0f && raster->y < height;
}
