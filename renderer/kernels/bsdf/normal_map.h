// SPDX-License-Identifier: MIT
// Maps of normals and heights: the shading normals that they tilt, and the shadowing of the tilt.
//
// Conventions are those of Mitsuba 3's plugins normalmap and bumpmap:
// - A texel of a map of normals is n = 2 t - 1 in the frame of dp/du and the shading normal.
// - A map of heights displaces p to p + h n. Derivatives of the normal are neglected.
// - If wo is below the horizon of the tilted normal, the tilt is reversed (V. Schuessler et al.,
//   "Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing", TOG 36(6), 2017). If
//   that does not help, the geometric normal applies (surface_frame.h).
// - Light is shadowed like that of a microsurface whose normals have the tilt (A. Conty Estevez, P.
//   Lecocq, C. Stein, "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem",
//   Ray Tracing Gems, 2019).
#pragma once

#include "renderer/kernels/bsdf/surface_frame.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/texture/texture.h"
#include "renderer/shared/scene_records.h"

/// Returns the unit vector along `v`, or `fallback` if v has no length or is not finite.
DEVICE float3 unit_or(float3 v, float3 fallback) {
    // Scaled first, because the square of a length may not be a float.
    const float3 magnitude = fabs(v);
    const float largest = max(magnitude.x, max(magnitude.y, magnitude.z));
    return largest > 0.0f && largest < INFINITY ? normalize(v / largest) : fallback;
}

/// Returns the tilted normal of a map of normals, of any length. `n` is the shading normal.
DEVICE float3 normal_of_texel(PRIVATE const SceneView *scene, NormalMapRecord map, SurfaceHit hit,
                              float3 n) {
    const Frame axes = frame_from_tangent(n, hit.tangent);
    const float3 t = texture_lookup(scene->textures + map.texture, scene->texels, hit.uv);
    const bool is_mirrored = dot(cross(hit.gradient_u, hit.gradient_v), n) < 0.0f;
    const bool turns = (map.flags & NORMAL_MAP_FOLLOWS_V) != 0u && is_mirrored;
    const float x = map.scale * (2.0f * t.x - 1.0f);
    const float y = map.scale * (2.0f * t.y - 1.0f);
    return axes.x * x + axes.y * (turns ? -y : y) + n * (2.0f * t.z - 1.0f);
}

/// Returns the normal of a surface displaced by a map of heights, of any length. `n` is the shading
/// normal on the side of the geometric normal.
DEVICE float3 normal_of_heights(PRIVATE const SceneView *scene, NormalMapRecord map, SurfaceHit hit,
                                float3 n) {
    const float2 slope = texture_gradient(scene->textures + map.texture, scene->texels, hit.uv);
    const float3 ng = hit.point.normal;
    // The gradient of the height is along the geometric surface. Its projection along ng to the
    // plane of n has the same products with dp/du and dp/dv. The normal minus it is multiplied by
    // cos(ng, n).
    const float3 gradient = (hit.gradient_u * slope.x + hit.gradient_v * slope.y) * map.scale;
    return (n - gradient) * dot(ng, n) + ng * dot(gradient, n);
}

/// Returns the unit vector `tilted` with its component perpendicular to `n` reversed.
DEVICE float3 reverse_tilt(float3 tilted, float3 n) {
    return n * (2.0f * dot(tilted, n)) - tilted;
}

/// Returns the frame of a hit whose material has map `map`, seen from wo.
DEVICE SurfaceFrame mapped_frame(PRIVATE const SceneView *scene, NormalMapRecord map,
                                 SurfaceHit hit, float3 tangent, float3 wo) {
    const float3 ng = hit.point.normal;
    const float3 n = dot(hit.normal, ng) >= 0.0f ? hit.normal : -hit.normal;
    const bool has_heights = FEATURE_bump_maps && (map.flags & NORMAL_MAP_HEIGHTS) != 0u;
    const float3 tilted = unit_or(
        has_heights ? normal_of_heights(scene, map, hit, n) : normal_of_texel(scene, map, hit, n),
        n);
    const bool front = dot(ng, wo) >= 0.0f;
    float3 facing = front ? tilted : -tilted;
    if (!front && (map.flags & NORMAL_MAP_MIRRORED_BACK) != 0u) {
        facing = reverse_tilt(facing, n);
    }
    if (!(dot(facing, wo) > 0.0f)) {
        facing = reverse_tilt(facing, n);
    }
    SurfaceFrame frame = make_surface_frame(ng, ng, tangent, hit.uv, wo);
    frame.ns = dot(facing, wo) > 0.0f ? facing : frame.ng;
    const Frame axes = frame_from_tangent(frame.ns, tangent);
    frame.x = axes.x;
    frame.y = axes.y;
    if ((map.flags & NORMAL_MAP_SHADOWING) != 0u) {
        frame.untilted = make_float3(dot(frame.x, n), dot(frame.y, n), dot(frame.ns, n));
        // min(tan^2 / 8, 1)
        const float cos2 = dot(tilted, n) * dot(tilted, n);
        const float sin2 = 0.125f * max(1.0f - cos2, 0.0f);
        frame.shadowing_alpha2 = sin2 < cos2 ? sin2 / cos2 : 1.0f;
    }
    return frame;
}
