// SPDX-License-Identifier: MIT
// The orthographic camera, whose rays are parallel to its axis: rays through the film, and
// connections to the film. It is the limit of a pinhole at an infinite distance.
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

/// Returns the ray through film position (x, y), in pixels from the top left corner. A uniform
/// position in a pixel has density 1 / pixel_area per area perpendicular to the ray. With the box
/// filter of one pixel, the measured radiance has weight 1.
DEVICE CameraRay orthographic_ray(CameraRecord camera, float x, float y) {
    CameraRay ray;
    ray.origin = make_float3(camera.position[0], camera.position[1], camera.position[2]) +
                 make_float3(camera.corner[0] + x * camera.step_x[0] + y * camera.step_y[0],
                             camera.corner[1] + x * camera.step_x[1] + y * camera.step_y[1],
                             camera.corner[2] + x * camera.step_x[2] + y * camera.step_y[2]);
    ray.direction = camera_forward(camera);
    return ray;
}

/// Connects a point to the film; the inverse of `orthographic_ray`. `lens_point` is the origin of
/// the ray through the point. `pdf_w` is d^2 / pixel_area for the distance d between both, so that
/// pdf_w / d^2 is the density of the ray per area perpendicular to it, as for other cameras.
DEVICE CameraConnection orthographic_connection(CameraRecord camera, float3 point) {
    const float3 forward = camera_forward(camera);
    const float3 from =
        point - make_float3(camera.position[0], camera.position[1], camera.position[2]);
    const float depth = dot(from, forward);
    CameraConnection connection;
    connection.lens_point = point - forward * depth;
    connection.raster = make_float2(0.0f, 0.0f);
    connection.pdf_w = 0.0f;
    if (!(depth > 0.0f)) {
        return connection;
    }
    const float3 step_x = make_float3(camera.step_x[0], camera.step_x[1], camera.step_x[2]);
    const float3 step_y = make_float3(camera.step_y[0], camera.step_y[1], camera.step_y[2]);
    const float width = (float)camera.width, height = (float)camera.height;
    // The steps have the length of a pixel, so a division by its area gives pixels. Comparisons are
    // such that overflow and NaN count as outside the film.
    const float2 raster = make_float2(0.5f * width + dot(from, step_x) / camera.pixel_area,
                                      0.5f * height + dot(from, step_y) / camera.pixel_area);
    if (raster.x >= 0.0f && raster.x < width && raster.y >= 0.0f && raster.y < height) {
        const float3 along = point - connection.lens_point;
        connection.raster = raster;
        connection.pdf_w = dot(along, along) / camera.pixel_area;
    }
    return connection;
}
