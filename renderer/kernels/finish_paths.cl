// SPDX-License-Identifier: MIT
// Stage finish_paths: the round of the last few paths of a batch. A work-item advances one path by
// up to FINISH_EVENTS events.
//
// Light trapped in glass scatters for thousands of events. With few such paths left, the launches
// of ordinary rounds would cost more than the paths themselves.
//
// Reads and writes: path states, active queue.
// Writes: film; ray counts.
// Enqueues: active queue of the next round.

#include "renderer/kernels/advance_path.h"
#include "renderer/shared/finish_paths.h"

__kernel void finish_paths(SCENE_PARAMETERS, CameraRecord camera, GLOBAL long *film_words,
                           GLOBAL long *half_film_words, IntegratorSettings settings,
                           ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SCENE_VIEW;
    const uint i = get_global_id(0);
    if (i >= active_count(counters)) {
        return;
    }
    uint words[PATH_STATE_WORDS];
    const PathStates paths = {words, 1u};
    const uint slot = active_queue(queues, counters, capacity)[i];
    for (uint word = 0u; word < PATH_STATE_WORDS; ++word) {
        words[word] = path_words[STREAM_WORD(capacity, slot, word)];
    }
    const FilmView film = {film_words, half_film_words, counters};
    RayCounts rays = {0u, 0u};
    bool goes_on = true;
    for (uint event = 0u; goes_on && event < FINISH_EVENTS; ++event) {
        goes_on = advance_path(paths, &scene, camera, film, settings, first_sample, &rays);
    }
    count_rays(counters, rays);
    if (!goes_on) {
        end_path(paths, 0u, film, first_sample);
        return;
    }
    for (uint word = 0u; word < PATH_STATE_WORDS; ++word) {
        path_words[STREAM_WORD(capacity, slot, word)] = words[word];
    }
    PushBuffer extended;
    extended.count = 0u;
    push_slot(&extended, slot);
    append_active(queues, counters, capacity, 1u - counters->parity, &extended);
}
