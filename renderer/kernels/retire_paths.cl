// SPDX-License-Identifier: MIT
// Stage retire_paths: ends all active paths and adds them to the film.
//
// STAGE(retire_paths,
//       reads(active, pixel, sample, radiance),
//       writes(film),
//       to(free))

#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/path/retire.h"
#include "renderer/kernels/stream.h"

__kernel void retire_paths(GLOBAL long *film_words, ulong first_sample, STREAM_PARAMETERS) {
    const Stream stream = STREAM_VIEW;
    const FilmView film = {film_words, counters, first_sample};
    PushBuffer ended;
    ended.count = 0u;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        const Path path = path_at(stream, active_queue(stream), i, i_end);
        prefetch_film(path, film);
        push_slot(&ended, path.slot);
    }
    for (uint i = 0u; i < ended.count; ++i) {
        add_path(path_in(stream, ended.slots[i]), film);
    }
    append_free(stream, &ended);
}
