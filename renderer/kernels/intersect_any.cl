// SPDX-License-Identifier: MIT
// Stage intersect_any: adds the light samples that nothing blocks.
// Reads: ray_origin, shadow_vector, shadow_radiance, shadow queue. Writes: radiance.

#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_bvh.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_buffers.h"

__kernel void intersect_any(BVH_PARAMETERS STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, counters->shadow) {
        const uint slot = queues[QUEUE_SHADOW * capacity + i];
        if (!trace_any(bvh_nodes, bvh_triangles, get_ray_origin(paths, slot), get_shadow_vector(paths, slot), 1.0f)) {
            set_radiance(paths, slot, get_radiance(paths, slot) + get_shadow_radiance(paths, slot));
        }
    }
}
