// SPDX-License-Identifier: MIT
// Stage run_tail: the round of the last few paths of a batch, its tail. A work-item advances one
// path by up to TAIL_EVENTS events.
//
// Light trapped in glass scatters for thousands of events. With few such paths left, the launches
// of ordinary rounds would cost more than the paths themselves.
//
// STAGE(run_tail,
//       reads(active, path),
//       writes(path, film, half_film, counters),
//       to(next))

#define PATH_STATES_PRIVATE 1

#include "renderer/kernels/path/advance.h"
#include "renderer/kernels/path/retire.h"
#include "renderer/kernels/stream.h"
#include "renderer/shared/tail.h"

/// Advances a path by up to TAIL_EVENTS events. Returns false if it ends.
DEVICE bool advance_far(Path path, PRIVATE const SceneView *scene, CameraRecord camera,
                        FilmView film, IntegratorSettings settings, ulong first_sample,
                        PRIVATE RayCounts *rays) {
    bool continues = true;
    for (uint event = 0u; continues && event < TAIL_EVENTS; ++event) {
        continues = advance_path(path, scene, camera, film, settings, first_sample, rays);
    }
    return continues;
}

/// Copies the words of a path from the stream.
DEVICE void load_path(Stream stream, Path path, uint slot) {
    for (uint word = 0u; word < PATH_STATE_WORDS; ++word) {
        PATH_WORD(path, word) = stream.path_words[STREAM_WORD(stream.capacity, slot, word)];
    }
}

/// Copies the words of a path to the stream.
DEVICE void store_path(Stream stream, Path path, uint slot) {
    for (uint word = 0u; word < PATH_STATE_WORDS; ++word) {
        stream.path_words[STREAM_WORD(stream.capacity, slot, word)] = PATH_WORD(path, word);
    }
}

/// Appends a path to the active queue of the next round.
DEVICE void continue_path(Stream stream, uint slot) {
    PushBuffer continued;
    continued.count = 0u;
    push_slot(&continued, slot);
    append_continued(stream, &continued);
}

__kernel void run_tail(SCENE_PARAMETERS, CameraRecord camera, GLOBAL long *film_words,
                       GLOBAL long *half_film_words, IntegratorSettings settings,
                       ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SCENE_VIEW;
    const Stream stream = STREAM_VIEW;
    const FilmView film = {film_words, counters, first_sample};
    uint words[PATH_STATE_WORDS];
    const Path path = {words, 1u, 0u};
    RayCounts rays = {0u, 0u};
    const uint i = get_global_id(0);
    if (i < active_count(stream)) {
        const uint slot = active_queue(stream)[i];
        load_path(stream, path, slot);
        if (advance_far(path, &scene, camera, film, settings, first_sample, &rays)) {
            store_path(stream, path, slot);
            continue_path(stream, slot);
        } else {
            retire_path(path, film, half_film_words);
        }
        count_rays(counters, rays);
    }
}
