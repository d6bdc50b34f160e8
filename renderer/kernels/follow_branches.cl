// SPDX-License-Identifier: MIT
// Stage follow_branches: continues each active path by ideal reflection or refraction, or from the
// last vertex that has components left.
//
// STAGE(follow_branches,
//       reads(active, hit, pixel, sample, depth, ray_direction, throughput, radiance, pending,
//       branches), writes(depth, ray_origin, ray_direction, throughput, pdf_w, pending, branches,
//       film), to(next, free))

#include "renderer/kernels/path/branches.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/path/retire.h"
#include "renderer/kernels/stream.h"

__kernel void follow_branches(SHADING_PARAMETERS, GLOBAL long *film_words,
                              IntegratorSettings settings, ulong first_sample,
                              GLOBAL uint *branch_words, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    const FilmView film = {film_words, counters, first_sample};
    PushBuffer continued, ended;
    continued.count = 0u;
    ended.count = 0u;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        const Path path = path_at(stream, active_queue(stream), i, i_end);
        if (next_branch(path, &scene, branch_words, settings)) {
            push_slot(&continued, path.slot);
        } else {
            add_path(path, film);
            push_slot(&ended, path.slot);
        }
    }
    append_continued(stream, &continued);
    append_free(stream, &ended);
}
