// SPDX-License-Identifier: MIT
// Stage splat_unblocked: traces the shadow rays of light paths and adds the paths visible to the
// camera to the film.
//
// Reads: ray_origin, shadow_vector, shadow_radiance, splat_pixel, shadow queue.
// Writes: film.

#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/shadow_ray.h"
#include "renderer/shared/path_state.h"

/// Adds the shadow radiance of a light path to the film unless its shadow ray is blocked.
DEVICE void splat(PathStates paths, uint slot, PRIVATE const SceneView *scene, FilmView film) {
    const uint pixel = get_splat_pixel(paths, slot);
    const float3 radiance = get_shadow_radiance(paths, slot);
    prefetch_pixel(film, pixel, radiance);
    if (!is_blocked(scene, get_ray_origin(paths, slot), get_shadow_vector(paths, slot))) {
        add_to_pixel(film, pixel, radiance);
    }
}

#if !PATH_STATES_PRIVATE

__kernel void splat_unblocked(TRACING_PARAMETERS, GLOBAL long *film_words,
                              GLOBAL long *half_film_words, STREAM_PARAMETERS) {
    const SceneView scene = TRACING_VIEW;
    const PathStates paths = {path_words, capacity};
    const FilmView film = {film_words, half_film_words, counters};
    FOR_EACH_ENTRY(i, counters->shadow) {
        const uint slot = path_at(paths, queues + QUEUE_SHADOW * capacity, i, i_end);
        splat(paths, slot, &scene, film);
    }
}

#endif
