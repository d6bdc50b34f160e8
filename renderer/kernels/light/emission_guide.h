// SPDX-License-Identifier: MIT
// Guided emission: tables of the directions in which light paths leave a light, and of the lights.
//
// A light with a table has a density g over the unit square of two random numbers (u, v), constant
// in each bin (shared/guide_layout.h) and with mean 1. The square stands for the directions of
// unguided emission:
// - Flat lights: the hemisphere about the axis z of the light, in proportion to the cosine. The
//   point of the surface is independent of the direction.
// - Spheres: all directions, in world axes. The point is uniform on the silhouette in that
//   direction. A sphere of uniform radiance emits its rays so.
// - Point lights: all directions, in world axes.
//
// In all of them p_o p_d of MIS (4) is g times the value of unguided emission. For spheres the
// split of this product is a formality: p_o is kept, and p_d has the factor g.
//
// A flat table keeps the directions that there are without a table, except those of spheres.
#pragma once

#include "renderer/kernels/sampling/guide_table.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns whether emission is guided.
DEVICE bool is_guided(PRIVATE const SceneView *scene) {
    return FEATURE_guided_emission && scene->emission_guide;
}

/// Returns whether a light, as `light_at` returns it, has a table.
DEVICE bool has_guide_table(LightRecord light) {
    return FEATURE_guided_emission && light.guide_table != NO_GUIDE_TABLE;
}

/// Returns the record of a light. If emission is guided, `emission_selection` and `guide_table` are
/// those of the guide.
DEVICE LightRecord light_at(PRIVATE const SceneView *scene, uint index) {
    LightRecord light = scene->lights[index];
    if (is_guided(scene)) {
        const uint count = scene->lighting.light_count;
        light.emission_selection =
            selection_range(scene->emission_guide, 0u, count, index).count * 0x1p-32f;
        light.guide_table = scene->emission_guide[count + index];
    }
    return light;
}

/// Returns the bin of the table of a light with direction `d` (unit, away from the light). For flat
/// lights, `d` is on the side that emits.
DEVICE GuideBin guide_bin(LightRecord light, float3 d) {
    if (light.kind > LIGHT_DISC) {
        return sphere_bin(d);
    }
    const float x = light.axis_x[0] * d.x + light.axis_x[1] * d.y + light.axis_x[2] * d.z;
    const float y = light.axis_y[0] * d.x + light.axis_y[1] * d.y + light.axis_y[2] * d.z;
    return bin_of_turn(x * x + y * y, x, y);
}

/// Returns g of a light in direction `d`, as in `guide_bin`; 1 if the light has no table.
DEVICE float guide_density(PRIVATE const SceneView *scene, LightRecord light, float3 d) {
    return has_guide_table(light)
               ? guide_bin_density(scene->emission_guide, light.guide_table, guide_bin(light, d))
               : 1.0f;
}

/// Samples a point of a light's unit square from a word for u and one for v.
DEVICE GuideSample sample_guide(PRIVATE const SceneView *scene, LightRecord light, uint word_u,
                                uint word_v) {
    if (has_guide_table(light)) {
        return sample_table(scene->emission_guide, light.guide_table, word_u, word_v);
    }
    GuideSample sample;
    sample.u = uniform_float(word_u);
    sample.v = uniform_float(word_v);
    sample.density = 1.0f;
    return sample;
}
