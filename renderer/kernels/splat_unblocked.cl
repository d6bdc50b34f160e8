// SPDX-License-Identifier: MIT
// Stage splat_unblocked: traces the shadow rays of light paths and adds the paths visible to the
// camera to the film.
//
// STAGE(splat_unblocked,
//       reads(shadow, sample, ray_origin, shadow_origin, shadow_vector, shadow_radiance,
//             splat_pixel, trials),
//       writes(film, trials))

#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/path/splat.h"
#include "renderer/kernels/stream.h"

__kernel void splat_unblocked(TRACING_PARAMETERS, GLOBAL long *film_words, ulong first_sample,
                              STREAM_PARAMETERS) {
    const SceneView scene = TRACING_VIEW;
    const Stream stream = STREAM_VIEW;
    const FilmView film = {film_words, counters, first_sample};
    FOR_EACH_ENTRY(i, shadow_count(stream)) {
        splat(path_at(stream, shadow_queue(stream), i, i_end), &scene, film);
    }
}
