// SPDX-License-Identifier: MIT
// Stages count_nearest_rays and count_shadow_rays: count by depth the rays of the active paths and
// of the shadow queue.

#include "renderer/kernels/film/film.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/stream.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/ray_counts.h"

/// Counts one ray. `counts` has RAY_DEPTHS entries of each kind.
DEVICE void count_ray(GLOBAL long *counts, uint kind, uint depth) {
    film_add_word(counts + kind * RAY_DEPTHS + min(depth, RAY_DEPTHS - 1u), 1);
}

__kernel void count_nearest_rays(GLOBAL long *ray_counts, STREAM_PARAMETERS) {
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        count_ray(ray_counts, RAY_NEAREST, get_depth(path_in(stream, active_queue(stream)[i])));
    }
}

__kernel void count_shadow_rays(GLOBAL long *ray_counts, STREAM_PARAMETERS) {
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, shadow_count(stream)) {
        count_ray(ray_counts, RAY_SHADOW, get_depth(path_in(stream, shadow_queue(stream)[i])));
    }
}
