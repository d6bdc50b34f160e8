// SPDX-License-Identifier: MIT
// Stage intersect_nearest: finds the nearest hits of the rays of the active paths.
//
// Reads: ray_origin, ray_direction, active queue.
// Writes: hit_primitive, hit_u, hit_v, hit_w.

#include "renderer/kernels/geometry/intersect_shapes.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_records.h"

/// Finds the nearest hit of a ray: triangles through the hierarchy, then the few shapes one after
/// the other.
DEVICE void find_hit(PathStates paths, uint slot, PRIVATE const SceneView *scene, float3 origin,
                     float3 direction) {
    uint primitive = NO_HIT;
    float3 at = make_float3(0.0f, 0.0f, 0.0f);
    float t = INFINITY;
    if (FEATURE_triangles) {
        const Hit hit = trace_nearest(scene->bvh_nodes, scene->bvh_triangles, origin, direction, t);
        if (hit.triangle != NO_HIT) {
            primitive = hit.triangle;
            at = make_float3(hit.u, hit.v, 0.0f);
            t = hit.t;
        }
    }
    if (FEATURE_shapes) {
        const ShapeHit shape = nearest_shape(scene->shapes, scene->shape_bounds, scene->shape_count,
                                             origin, direction, t);
        if (shape.shape != NO_HIT) {
            primitive = SHAPE_BIT | shape.shape;
            at = shape.object_point;
        }
    }
    set_hit_primitive(paths, slot, primitive);
    set_hit_u(paths, slot, at.x);
    set_hit_v(paths, slot, at.y);
    set_hit_w(paths, slot, at.z);
}

#if !PATH_STATES_PRIVATE

__kernel void intersect_nearest(TRACING_PARAMETERS, STREAM_PARAMETERS) {
    const SceneView scene = TRACING_VIEW;
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = path_at(paths, active_queue(queues, counters, capacity), i, i_end);
        find_hit(paths, slot, &scene, get_ray_origin(paths, slot), get_ray_direction(paths, slot));
    }
}

#endif
