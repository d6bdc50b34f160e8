// SPDX-License-Identifier: MIT
// Adds the samples of paths to the film and counts those that the film rejects.
#pragma once

#include "renderer/kernels/film/convergence.h"
#include "renderer/kernels/film/film.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/stream_counters.h"

/// The films to which a stage adds samples, and the counters of rejected samples.
typedef struct FilmView {
    GLOBAL long *words;
    GLOBAL long *half_words;  ///< the half film; read only with FEATURE_convergence
    GLOBAL StreamCounters *counters;
} FilmView;

/// Prefetches the words of a pixel that adding `sample` will change, judged by its largest channel.
DEVICE void prefetch_pixel(FilmView film, uint pixel, float3 sample) {
    if (!PREFETCHES) {
        return;
    }
    GLOBAL const long *words = film.words + (ulong)pixel * FILM_PIXEL_WORDS(FEATURE_variance);
    const float largest = max(sample.x, max(sample.y, sample.z));
    const uint word = min(film_word(largest, FILM_SUM_LOWEST, FILM_SUM_STEP), FILM_WORDS - 1u);
    PREFETCH(words + word * PIXEL_SUMS);
    PREFETCH(words + word * PIXEL_SUMS + 2);
    if (FEATURE_variance) {
        const uint square = min(film_word(largest * largest, FILM_SQUARE_LOWEST, FILM_SQUARE_STEP),
                                FILM_WORDS - 1u);
        PREFETCH(words + square * PIXEL_SUMS + 3);
    }
}

/// Adds a sample to a pixel and returns whether the film accepted it. Counts a rejected sample as
/// an error.
DEVICE bool add_to_pixel(FilmView film, uint pixel, float3 sample) {
    const uint error =
        film_add_sample(film.words + (ulong)pixel * FILM_PIXEL_WORDS(FEATURE_variance), sample);
    if (error != 0u) {
        atomic_inc(error == FILM_NON_FINITE ? &film.counters->non_finite
                                            : &film.counters->out_of_range);
    }
    return error == 0u;
}

/// Adds the radiance of a camera path that ends here. Returns whether the film accepted it.
DEVICE bool add_path(PathStates paths, uint slot, FilmView film) {
    return add_to_pixel(film, get_pixel(paths, slot), get_radiance(paths, slot));
}

/// Adds a camera path that the film accepted to the half film, if its sample has an even index.
DEVICE void add_path_to_half(PathStates paths, uint slot, FilmView film, ulong first_sample) {
    const float3 radiance = get_radiance(paths, slot);
    if (half_film_add_sample(film.half_words, get_pixel(paths, slot),
                             first_sample + get_sample(paths, slot), radiance) != 0u) {
        atomic_inc(&film.counters->out_of_range);
    }
}
