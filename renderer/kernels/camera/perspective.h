// SPDX-License-Identifier: MIT
// The perspective camera: rays through the film, their densities, and connections to the lens. Its
// functions also serve orthographic cameras (orthographic.h).
#pragma once

#include "renderer/kernels/camera/camera_ray.h"
#include "renderer/kernels/camera/orthographic.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns the point of the lens that (u, v) samples, relative to its centre.
DEVICE float3 point_on_lens(CameraRecord camera, float u, float v) {
    const float2 disc = sample_disc(u, v);
    return (make_float3(camera.axis_x[0], camera.axis_x[1], camera.axis_x[2]) * disc.x +
            make_float3(camera.axis_y[0], camera.axis_y[1], camera.axis_y[2]) * disc.y) *
           camera.aperture_radius;
}

/// Returns the point of a ray of `camera_ray` at camera.start_distance from the lens.
///
/// With `lateral`, the ray's direction across the axis where its component along the axis is 1, and
/// n the length of both, the direction is (lateral + forward) / n. Only its difference from forward
/// is multiplied by the large distance: (lateral - forward |lateral|^2 / (1 + n)) / n.
DEVICE float3 start_near_scene(CameraRecord camera, float x, float y, float3 on_lens) {
    const float3 film =
        make_float3(camera.start_corner[0] + x * camera.step_x[0] + y * camera.step_y[0],
                    camera.start_corner[1] + x * camera.step_x[1] + y * camera.step_y[1],
                    camera.start_corner[2] + x * camera.step_x[2] + y * camera.step_y[2]);
    const float3 lateral = film - on_lens / camera.focus_distance;
    const float square = dot(lateral, lateral);
    const float n = sqrt(1.0f + square);
    const float3 start = make_float3(camera.start[0], camera.start[1], camera.start[2]);
    return start + on_lens +
           (lateral - camera_forward(camera) * (square / (1.0f + n))) * (camera.start_distance / n);
}

/// Returns the ray through film position (x, y), in pixels from the top left corner, and the point
/// of the lens that (u, v) samples. It begins on the lens, or at camera.start_distance from it.
///
/// A uniform position in a pixel has density p_v = 1 / pixel_area per area at unit distance. A
/// uniform point of the lens has density p_l = 1 / (pi r^2) per area (thesis (2.46)). With the box
/// filter of one pixel, the measured radiance has weight 1. Behind a thin lens all rays of a film
/// position meet in one point of the plane in focus. The ray through the centre of the lens, which
/// is not refracted, determines this point.
DEVICE CameraRay camera_ray(CameraRecord camera, float x, float y, float u, float v) {
    if (FEATURE_orthographic && camera.orthographic != 0u) {
        return orthographic_ray(camera, x, y);
    }
    float3 towards = make_float3(camera.corner[0] + x * camera.step_x[0] + y * camera.step_y[0],
                                 camera.corner[1] + x * camera.step_x[1] + y * camera.step_y[1],
                                 camera.corner[2] + x * camera.step_x[2] + y * camera.step_y[2]);
    CameraRay ray;
    ray.origin = make_float3(camera.position[0], camera.position[1], camera.position[2]);
    if (FEATURE_lens) {
        const float3 on_lens = point_on_lens(camera, u, v);
        ray.origin += on_lens;
        // Not 0: the component of `towards` along the axis is 1 before scaling, that of the lens
        // point is 0.
        towards = towards * camera.focus_distance - on_lens;
        if (camera.start_distance > 0.0f) {
            ray.origin = start_near_scene(camera, x, y, on_lens);
        }
    }
    ray.direction = normalize(towards);
    return ray;
}

/// Returns the density per solid angle at the lens point of this ray of `camera_ray`, for one
/// sample per pixel of the film. It is the first factor of P_1 in MIS (6).
///
/// Per area of the plane at unit distance the density is 1 / pixel_area, whatever the lens point
/// and the plane in focus, and dw = cos^3 dA there. With the box filter of one pixel, it also
/// equals the importance times the cosine at the lens, over the density of the lens point (Veach
/// 1997, section 8.2). The measured radiance thus has weight 1.
///
/// The density of an orthographic ray is per area perpendicular to it.
DEVICE float camera_pdf_w(CameraRecord camera, float3 direction) {
    if (FEATURE_orthographic && camera.orthographic != 0u) {
        return 1.0f / camera.pixel_area;
    }
    const float cosine = dot(direction, camera_forward(camera));
    return 1.0f / (camera.pixel_area * cosine * cosine * cosine);
}

/// Connects a point to the point of the lens that (u, v) samples; the inverse of `camera_ray`. Let
/// radiance L arrive at the lens point from an area dA around the point, at distance d, with `cos`
/// the cosine at the area. It adds L cos pdf_w / d^2 dA to the mean radiance of the pixel at
/// `raster`.
DEVICE CameraConnection camera_connection(CameraRecord camera, float3 point, float u, float v) {
    if (FEATURE_orthographic && camera.orthographic != 0u) {
        return orthographic_connection(camera, point);
    }
    CameraConnection connection;
    connection.lens_point = make_float3(camera.position[0], camera.position[1], camera.position[2]);
    connection.raster = make_float2(0.0f, 0.0f);
    connection.pdf_w = 0.0f;
    float3 on_lens = make_float3(0.0f, 0.0f, 0.0f);
    if (FEATURE_lens) {
        on_lens = point_on_lens(camera, u, v);
        connection.lens_point += on_lens;
    }
    float3 from_lens = point - connection.lens_point;
    float depth = dot(from_lens, camera_forward(camera));
    float3 across = from_lens;  // `from_lens`, up to a multiple of the axis
    if (FEATURE_lens && camera.start_distance > 0.0f) {
        const float3 forward = camera_forward(camera);
        across = point - make_float3(camera.start[0], camera.start[1], camera.start[2]) - on_lens;
        depth = camera.start_distance + dot(across, forward);
        from_lens = across + forward * camera.start_distance;
    }
    if (!(depth > 0.0f)) {
        return connection;
    }
    // Intersections with the plane at unit distance: `slope` of the ray, `seen` of the ray through
    // the centre of the lens to the same point in focus. Comparisons are such that overflow and NaN
    // count as outside the film, and nothing is squared before them. Inside the film, |slope|^2 is
    // at most 1 / cos^2 of the field of view, plus that of the lens over the focus distance.
    const float3 slope = from_lens / depth;
    float3 seen = slope;
    if (FEATURE_lens) {
        // The axis is perpendicular to the steps only up to rounding, which a far camera magnifies.
        seen = across / depth;
        seen += on_lens / camera.focus_distance;
    }
    float2 raster;
    if (set_raster(camera, seen, &raster)) {
        const float square = dot(slope, slope);  // 1 / cos^2
        connection.raster = raster;
        connection.pdf_w = square * sqrt(square) / camera.pixel_area;
    }
    return connection;
}
