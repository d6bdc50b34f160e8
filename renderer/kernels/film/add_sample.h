// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/kernels/film/film.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/stream_counters.h"

/// Adds to a pixel; what the film refuses is counted.
DEVICE void add_to_pixel(GLOBAL long *film, uint pixel, float3 sample, GLOBAL StreamCounters *counters) {
    const uint error = film_add_sample(film + (ulong)pixel * FILM_PIXEL_WORDS(FEATURE_variance), sample);
    if (error != 0u) {
        atomic_inc(error == FILM_NON_FINITE ? &counters->non_finite : &counters->out_of_range);
    }
}

#if FEATURE_from_camera

/// Adds what a camera path gathered, which ends here.
DEVICE void add_path(PathStates paths, uint slot, GLOBAL long *film, GLOBAL StreamCounters *counters) {
    add_to_pixel(film, get_pixel(paths, slot), get_radiance(paths, slot), counters);
}

#endif
