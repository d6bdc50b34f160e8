// SPDX-License-Identifier: MIT
// Stages that count rays by depth.

#include "renderer/kernels/film/film.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/stream.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/ray_counts.h"

/// Counts one ray. `counts` has RAY_DEPTHS entries of each kind.
DEVICE void count_ray(GLOBAL long *counts, uint kind, uint depth) {
    film_add_word(counts + kind * RAY_DEPTHS + min(depth, RAY_DEPTHS - 1u), 1);
}

/// Stage count_nearest_rays: counts the rays of the active paths.
///
/// STAGE(count_nearest_rays,
///       reads(active, depth),
///       writes(ray_counts))
__kernel void count_nearest_rays(GLOBAL long *ray_counts, STREAM_PARAMETERS) {
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        count_ray(ray_counts, RAY_NEAREST, get_depth(path_in(stream, active_queue(stream)[i])));
    }
}

/// Stage count_shadow_rays: counts the rays of the shadow queue.
///
/// STAGE(count_shadow_rays,
///       reads(shadow, depth),
///       writes(ray_counts))
__kernel void count_shadow_rays(GLOBAL long *ray_counts, STREAM_PARAMETERS) {
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, shadow_count(stream)) {
        count_ray(ray_counts, RAY_SHADOW, get_depth(path_in(stream, shadow_queue(stream)[i])));
    }
}
