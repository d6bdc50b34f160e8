// SPDX-License-Identifier: MIT
// The nearest hit of a path's ray.
#pragma once

#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/kernels/traversal/ray_opacity.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_records.h"

/// Finds the nearest hit of a path's ray: triangles through the hierarchy, then the few shapes one
/// after the other.
DEVICE void find_hit(Path path, PRIVATE const SceneView *scene) {
    const float3 origin = get_ray_origin(path), direction = get_ray_direction(path);
    const OpacityTest opacity = ray_opacity(scene, origin, direction);
    uint primitive = NO_HIT;
    float3 at = make_float3(0.0f, 0.0f, 0.0f);
    float t = INFINITY;
    if (FEATURE_triangles) {
        const Hit hit =
            trace_nearest(scene->bvh_nodes, scene->bvh_triangles, origin, direction, t, opacity);
        if (hit.triangle != NO_HIT) {
            primitive = hit.triangle;
            at = make_float3(hit.u, hit.v, 0.0f);
            t = hit.t;
        }
    }
    if (FEATURE_shapes) {
        const ShapeHit shape = nearest_shape(scene->shapes, scene->shape_bounds, scene->shape_count,
                                             origin, direction, t, opacity);
        if (shape.shape != NO_HIT) {
            primitive = SHAPE_BIT | shape.shape;
            at = shape.object_point;
        }
    }
    set_hit_primitive(path, primitive);
    set_hit_u(path, at.x);
    set_hit_v(path, at.y);
    set_hit_w(path, at.z);
}
