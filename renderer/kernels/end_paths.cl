// SPDX-License-Identifier: MIT
// Stage end_paths: ends all active paths and adds them to the film.
//
// Reads: pixel, radiance, active queue.
// Writes: film.
// Enqueues: free queue.

#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/stream.h"
#include "renderer/shared/path_state.h"

__kernel void end_paths(GLOBAL long *film_words, GLOBAL long *half_film_words, STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    const FilmView film = {film_words, half_film_words, counters};
    PushBuffer ended;
    ended.count = 0u;
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = path_at(paths, active_queue(queues, counters, capacity), i, i_end);
        prefetch_pixel(film, get_pixel(paths, slot), get_radiance(paths, slot));
        push_slot(&ended, slot);
    }
    for (uint i = 0u; i < ended.count; ++i) {
        add_path(paths, ended.slots[i], film);
    }
    append_slots(queues, QUEUE_FREE, capacity, &counters->free_slots, counters, &ended);
}
