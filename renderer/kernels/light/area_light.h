// SPDX-License-Identifier: MIT
// Diffuse area lights on meshes. A triangle is selected in proportion to its area, and a uniform
// point is sampled on it.
#pragma once

#include "renderer/kernels/geometry/surface.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/sampling/select.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// A point on a light.
typedef struct LightPoint {
    SurfacePoint point;  ///< emits on the side of its normal
    float pdf_a;         ///< conditional density per area, given the light
} LightPoint;

/// Samples a point on a mesh light from the last three words.
DEVICE LightPoint sample_mesh_light(GLOBAL const EmitterTriangle *emitter_triangles,
                                    GLOBAL const SurfaceTriangle *surface_triangles,
                                    LightRecord light, uint4 words) {
    uint picked = light.first_triangle;
    if (FEATURE_light_triangles) {
        SELECT_BY_WORD(emitter_triangles, .selection_end, light.first_triangle,
                       light.triangle_count, words.y, selected)
        picked = selected;
    }
    const EmitterTriangle emitter = emitter_triangles[picked];
    const float2 uv = sample_triangle(uniform_float(words.z), uniform_float(words.w));
    LightPoint sample;
    sample.point = scene_point(surface_triangles + emitter.triangle, uv.x, uv.y);
    sample.pdf_a = emitter.pdf_a;
    return sample;
}
