// SPDX-License-Identifier: MIT
// Stage intersect_any: adds the light samples that nothing blocks.
// Reads: ray_origin, shadow_vector, shadow_radiance, shadow queue. Writes: radiance.

#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/shadow_ray.h"
#include "renderer/shared/path_state.h"

__kernel void intersect_any(GEOMETRY_PARAMETERS STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, counters->shadow) {
        const uint slot = queues[QUEUE_SHADOW * capacity + i];
        if (!is_blocked(GEOMETRY_ARGUMENTS get_ray_origin(paths, slot), get_shadow_vector(paths, slot))) {
            set_radiance(paths, slot, get_radiance(paths, slot) + get_shadow_radiance(paths, slot));
        }
    }
}
