// SPDX-License-Identifier: MIT
// The orthographic camera, whose rays are parallel to its axis: rays through the film, and
// connections to the film. It is the limit of a pinhole at an infinite distance.
#pragma once

#include "renderer/kernels/camera/camera_ray.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

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
    float2 raster;
    if (set_raster(camera, from, &raster)) {
        const float3 along = point - connection.lens_point;
        connection.raster = raster;
        connection.pdf_w = dot(along, along) / camera.pixel_area;
    }
    return connection;
}
