// SPDX-License-Identifier: MIT
// The scattering frame of a hit.
#pragma once

#include "renderer/kernels/bsdf/normal_map.h"
#include "renderer/kernels/bsdf/surface_frame.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/scene_records.h"

/// Returns the frame in which a hit scatters, seen from wo. Its axes follow the surface's tangent
/// only if the material is anisotropic. A map of the material tilts its normal.
DEVICE SurfaceFrame shading_frame(PRIVATE const SceneView *scene, SurfaceHit hit, float3 wo) {
    SurfaceFrame frame;
    float3 tangent = make_float3(0.0f, 0.0f, 0.0f);
    if (FEATURE_tangents && (scene->materials[hit.material].flags & MATERIAL_TURNS) != 0u) {
        tangent = hit.tangent;
    }
    if (FEATURE_normal_maps && (scene->materials[hit.material].flags & MATERIAL_MAPPED) != 0u) {
        frame = mapped_frame(scene, scene->normal_maps[scene->materials[hit.material].normal_map],
                             hit, tangent, wo);
    } else {
        frame = make_surface_frame(hit.point.normal, hit.normal, tangent, hit.uv, wo);
    }
    if (FEATURE_vertex_colours) {
        frame.colour = hit.colour;
    }
    return frame;
}
