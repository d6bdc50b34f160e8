// SPDX-License-Identifier: MIT
// The frame in which a surface scatters: shading normal, tangents, geometric normal, and the side
// from which the path came.
#pragma once

#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/shared/compat.h"

/// Scattering frame in world space. Both normals are on wo's side. x and y complete ns to an
/// orthonormal frame, with x along the surface's tangent.
typedef struct SurfaceFrame {
    float3 x, y, ns;
    float3 ng;
    float3 wo;
    float2 uv;
    float3 colour;  ///< the colour of vertices, which multiplies some textures
    uint front;     ///< 1: wo is on the surface's front
    /// The shading normal before a map tilted it, in this frame, with either sign.
    float3 untilted;
    /// Squared roughness of the microsurface that a map suggests; 0 if it casts no shadows.
    float shadowing_alpha2;
} SurfaceFrame;

/// Returns a frame about the unit vector `z` with x as close to `tangent` as possible. Falls back
/// to frame_from_z if the tangent has no length or is not finite. Also falls back if it is closer
/// than 0.01 radians to `z`, where rounding would hide its direction perpendicular to `z`.
DEVICE Frame frame_from_tangent(float3 z, float3 tangent) {
    // The tangent is scaled first: a derivative of a position by u may have any size, and its
    // square may not be a float.
    const float3 magnitude = fabs(tangent);
    const float largest = max(magnitude.x, max(magnitude.y, magnitude.z));
    if (largest > 0.0f && largest < INFINITY) {
        const float3 t = tangent / largest;
        const float3 y = cross(z, t);
        const float y2 = dot(y, y);
        if (y2 > 1e-4f * dot(t, t)) {
            Frame frame;
            frame.y = y / sqrt(y2);
            frame.x = cross(frame.y, z);
            frame.z = z;
            return frame;
        }
    }
    return frame_from_z(z);
}

/// Returns the frame at a point with unit normals `ng` and `ns`, both on the front, where ns may be
/// beyond ng's horizon. `tangent` may have any length (zero if there is none), and `wo` is unit. If
/// wo is below the horizon of the shading normal, ng replaces ns. Otherwise such a point would be
/// black, although the path hit it.
DEVICE SurfaceFrame make_surface_frame(float3 ng, float3 ns, float3 tangent, float2 uv, float3 wo) {
    SurfaceFrame frame;
    frame.front = dot(ng, wo) >= 0.0f ? 1u : 0u;
    frame.ng = frame.front != 0u ? ng : -ng;
    frame.ns = frame.ng;
    if (FEATURE_smooth_normals) {
        const float3 facing = dot(ns, frame.ng) >= 0.0f ? ns : -ns;
        frame.ns = dot(facing, wo) > 0.0f ? facing : frame.ng;
    }
    const Frame axes =
        FEATURE_tangents ? frame_from_tangent(frame.ns, tangent) : frame_from_z(frame.ns);
    frame.x = axes.x;
    frame.y = axes.y;
    frame.wo = wo;
    frame.uv = uv;
    frame.colour = make_float3(1.0f, 1.0f, 1.0f);
    frame.untilted = frame.ns;
    frame.shadowing_alpha2 = 0.0f;
    return frame;
}
