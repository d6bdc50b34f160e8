// SPDX-License-Identifier: MIT
// Stage intersect_nearest: finds what the rays of the active paths hit first.
// Reads: ray_origin, ray_direction, active queue. Writes: hit_triangle, hit_u, hit_v.

#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_buffers.h"

__kernel void intersect_nearest(BVH_PARAMETERS STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = active_slot(queues, counters, capacity, i);
        const Hit hit = trace_nearest(bvh_nodes, bvh_triangles, get_ray_origin(paths, slot), get_ray_direction(paths, slot),
                                      INFINITY);
        set_hit_triangle(paths, slot, hit.triangle);
        set_hit_u(paths, slot, hit.u);
        set_hit_v(paths, slot, hit.v);
    }
}
