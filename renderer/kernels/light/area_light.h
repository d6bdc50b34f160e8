// SPDX-License-Identifier: MIT
// Diffuse area lights on meshes. A triangle is selected in proportion to its area or, if the light
// has a texture, to its estimated power. A uniform point is sampled on it.
#pragma once

#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/sampling/select.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// A point on a light.
typedef struct LightPoint {
    SurfacePoint point;  ///< emits on the side of its normal
    float pdf_a;         ///< conditional density per area, given the light
    float2 uv;           ///< texture coordinates, if the light has a texture
} LightPoint;

/// Samples a point on a mesh light from the last three words.
DEVICE LightPoint sample_mesh_light(PRIVATE const SceneView *scene, LightRecord light,
                                    uint4 words) {
    uint picked = light.first_triangle;
    if (FEATURE_light_triangles) {
        SELECT_BY_WORD(scene->emitter_triangles, .selection_end, light.first_triangle,
                       light.triangle_count, words.y, selected)
        picked = selected;
    }
    const EmitterTriangle emitter = scene->emitter_triangles[picked];
    const float2 at = sample_triangle(uniform_float(words.z), uniform_float(words.w));
    LightPoint sample;
    sample.point = scene_point(scene->surface_triangles + emitter.triangle, at.x, at.y);
    sample.pdf_a = emitter.pdf_a;
    sample.uv = make_float2(0.0f, 0.0f);
    if (FEATURE_emission_textures && FEATURE_texture_coordinates && light.texture != NO_TEXTURE) {
        sample.uv = triangle_uv(scene, emitter.triangle, at.x, at.y);
    }
    return sample;
}
