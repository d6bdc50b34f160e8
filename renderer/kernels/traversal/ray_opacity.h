// SPDX-License-Identifier: MIT
// The opacity test of a ray through the scene.
#pragma once

#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/traversal/opacity.h"

/// Returns the opacity test of a ray. Directions need not be unit vectors.
DEVICE OpacityTest ray_opacity(MAYBE_UNUSED PRIVATE const SceneView *scene,
                               MAYBE_UNUSED float3 origin, MAYBE_UNUSED float3 direction) {
    OpacityTest test = all_opaque();
    if (FEATURE_opacity) {
        test.triangle_masks = scene->triangle_masks;
        test.masked_triangles = scene->masked_triangles;
        test.opacities = scene->opacities;
        test.texels = scene->opacity_texels;
        test.ray = hash_of_ray(origin, direction);
    }
    return test;
}
