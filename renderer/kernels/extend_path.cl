// SPDX-License-Identifier: MIT
// Stage extend_path: samples the next direction of each active path, or ends the path.
//
// The depth limit, roulette, a miss or a failed sample end it. A camera path that ends is added to
// the film; a light path adds nothing here. A path that continues also continues R or Q, and S
// (kernels/mis/truncated.h, kernels/mis/bidirectional.h).
//
// STAGE(extend_path,
//       reads(active, hit, pixel, sample, depth, ray_direction, throughput, roulette_scale,
//             radiance, log_running_ratio, log_inverse_arrival, log_strategies, trials),
//       writes(depth, ray_origin, ray_direction, throughput, roulette_scale, pdf_w,
//              log_running_ratio, log_strategies, trials, film, half_film),
//       to(next, free))

#include "renderer/kernels/path/hit_path_at.h"
#include "renderer/kernels/path/retire.h"
#include "renderer/kernels/path/scatter.h"
#include "renderer/kernels/path/words_at.h"
#include "renderer/kernels/stream.h"

__kernel void extend_path(SHADING_PARAMETERS, GLOBAL long *film_words, GLOBAL long *half_film_words,
                          IntegratorSettings settings, ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    const FilmView film = {film_words, counters, first_sample};
    WordBatch words;
    PushBuffer continued, ended;
    continued.count = ended.count = 0u;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        const Path path = shaded_path_at(&scene, stream, i, i_end);
        if (extend(path, &scene, settings, film,
                   scatter_words_at(&words, stream, i, i_end, settings, first_sample))) {
            push_slot(&continued, path.slot);
        } else {
            prefetch_film(path, film);
            push_slot(&ended, path.slot);
        }
    }
    // The first loop has prefetched the film words of these paths.
    for (uint i = 0u; i < ended.count; ++i) {
        retire_path(path_in(stream, ended.slots[i]), film, half_film_words);
    }
    append_continued(stream, &continued);
    append_free(stream, &ended);
}
