// SPDX-License-Identifier: MIT
// Shadow rays: whether the segment between two points is blocked.
#pragma once

#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/kernels/traversal/ray_opacity.h"
#include "renderer/shared/scene_records.h"

/// End of a shadow ray, as a fraction of its length. It is short of the light by more than the
/// rounding of the vector between the ends. For a small, distant light that rounding may exceed the
/// offset that keeps the light's surface from blocking itself.
#define SHADOW_END (1.0f - 0x1p-20f)

/// Returns whether a surface stops the ray between `origin` and `origin + segment`.
DEVICE bool is_blocked(PRIVATE const SceneView *scene, float3 origin, float3 segment) {
    const OpacityTest opacity = ray_opacity(scene, origin, segment);
    // The few shape tests often avoid the traversal.
    if (FEATURE_shapes && any_shape(scene->shapes, scene->shape_bounds, scene->shape_count, origin,
                                    segment, SHADOW_END, opacity)) {
        return true;
    }
    return FEATURE_triangles &&
           trace_any(scene->bvh_nodes, scene->bvh_triangles, origin, segment, SHADOW_END, opacity);
}
