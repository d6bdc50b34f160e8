// SPDX-License-Identifier: MIT
// Stage intersect_any: traces the shadow rays of camera paths and adds the connections that nothing
// blocks.
//
// Reads: ray_origin, shadow_vector, shadow_radiance, radiance, shadow queue.
// Writes: radiance.

#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/shadow_ray.h"
#include "renderer/shared/path_state.h"

/// Adds the shadow radiance of a path unless its shadow ray is blocked.
DEVICE void add_unblocked(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                          float3 origin, float3 way) {
    if (!is_blocked(scene, origin, way)) {
        set_radiance(paths, slot, get_radiance(paths, slot) + get_shadow_radiance(paths, slot));
    }
}

#if !PATH_STATES_PRIVATE

__kernel void intersect_any(TRACING_PARAMETERS, STREAM_PARAMETERS) {
    const SceneView scene = TRACING_VIEW;
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, counters->shadow) {
        const uint slot = path_at(paths, queues + QUEUE_SHADOW * capacity, i, i_end);
        add_unblocked(paths, slot, &scene, get_ray_origin(paths, slot),
                      get_shadow_vector(paths, slot));
    }
}

#endif
