// SPDX-License-Identifier: MIT
// Diffuse area lights on meshes, and the choice among them. Both tables are searched by 32-bit random words, and
// their probabilities are those of the words exactly: what is sampled is what the densities say.
#pragma once

#include "renderer/kernels/geometry/surface.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

#if FEATURE_lights

/// A point on a light.
typedef struct LightSample {
    SurfacePoint point;  ///< emits on the side of its normal
    float3 radiance;     ///< W / (sr m^2)
    float pdf_a;         ///< density per area, selection of the light included
} LightSample;

/// The index of the first entry whose `selection_end` exceeds `word`. Ends never decrease and the last one is
/// 2^32 - 1, which stands for 2^32; entries of probability 0 share their predecessor's end and are never taken.
#define SELECT_BY_WORD(table, first, count, word, selected)      \
    uint selected = (first);                                     \
    {                                                            \
        uint remaining = (count) - 1u;                           \
        while (remaining > 0u) {                                 \
            const uint half_ = (remaining + 1u) / 2u;             \
            if (table[selected + half_ - 1u].selection_end <= (word)) { \
                selected += half_;                                \
                remaining -= half_;                               \
            } else {                                             \
                remaining = half_ - 1u;                           \
            }                                                    \
        }                                                        \
    }

/// Samples a light, a triangle of it in proportion to area, and a uniform point there.
DEVICE LightSample sample_light_point(GLOBAL const LightRecord *lights, GLOBAL const EmitterTriangle *emitter_triangles,
                                      GLOBAL const SurfaceTriangle *surface_triangles, uint light_count, uint4 words) {
#if FEATURE_many_lights
    SELECT_BY_WORD(lights, 0u, light_count, words.x, chosen)
#else
    const uint chosen = 0u;
#endif
    const LightRecord light = lights[chosen];
#if FEATURE_light_triangles
    SELECT_BY_WORD(emitter_triangles, light.first_triangle, light.triangle_count, words.y, picked)
#else
    const uint picked = light.first_triangle;
#endif
    const EmitterTriangle emitter = emitter_triangles[picked];
    LightSample sample;
    const float2 uv = sample_triangle(uniform_float(words.z), uniform_float(words.w));
    sample.point = scene_point(surface_triangles + emitter.triangle, uv.x, uv.y);
    sample.radiance = make_float3(light.radiance[0], light.radiance[1], light.radiance[2]);
    sample.pdf_a = light.selection * emitter.pdf_a;
    return sample;
}

/// The density per area with which `sample_light_point` makes a point of an emitter triangle.
DEVICE float light_pdf_a(LightRecord light, EmitterTriangle emitter) { return light.selection * emitter.pdf_a; }

#endif
