// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/shared/scene_buffers.h"
#include "renderer/shared/scene_records.h"

/// The end of a shadow ray, in lengths of the way: short of the light by more than the rounding of
/// the way itself, which may exceed the distance that keeps the light's surface from blocking
/// itself where that is small and far away.
#define SHADOW_END (1.0f - 0x1p-20f)

/// Whether anything lies on the way from `origin` to `origin + way`.
DEVICE bool is_blocked(GEOMETRY_PARAMETERS float3 origin, float3 way) {
#if FEATURE_shapes
    // A handful of tests that often spare the traversal.
    if (any_shape(shapes, shape_bounds, shape_count, origin, way, SHADOW_END)) {
        return true;
    }
#endif
#if FEATURE_triangles
    return trace_any(bvh_nodes, bvh_triangles, origin, way, SHADOW_END);
#else
    return false;
#endif
}
