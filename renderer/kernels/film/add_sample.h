// SPDX-License-Identifier: MIT
// Adds samples to the film and counts those that the film rejects.
#pragma once

#include "renderer/kernels/film/film.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/stream_counters.h"

/// The film to which a stage adds samples, and the counters of rejected samples. With
/// FEATURE_light_path_trials the words are PathTrials instead.
typedef struct FilmView {
    GLOBAL long *words;
    GLOBAL StreamCounters *counters;
    ulong first_sample;  ///< index of the batch's first sample
} FilmView;

/// Returns the words of a pixel to which a path adds: with FEATURE_sequences, those of the Sobol
/// sequence of the path's sample.
DEVICE GLOBAL long *pixel_words(FilmView film, uint pixel, Path path) {
    GLOBAL long *words = film.words + (ulong)pixel * PIXEL_WORDS;
    if (FEATURE_sequences) {
        words += (film.first_sample + get_sample(path)) % SOBOL_SEQUENCES * FILM_CHANNELS;
    }
    return words;
}

/// Prefetches the words of a pixel that adding a path's contribution `sample` will change, judged
/// by its largest channel.
DEVICE void prefetch_pixel(FilmView film, uint pixel, Path path, float3 sample) {
    if (!PREFETCHES || FEATURE_light_path_trials) {
        return;
    }
    GLOBAL const long *words = pixel_words(film, pixel, path);
    const float largest = max(sample.x, max(sample.y, sample.z));
    const uint word = min(film_word(largest, FILM_SUM_LOWEST, FILM_SUM_STEP), FILM_WORDS - 1u);
    PREFETCH(words + word * PIXEL_SUMS);
    PREFETCH(words + word * PIXEL_SUMS + 2);
    if (HOLDS_SQUARES) {
        const uint square = min(film_word(largest * largest, FILM_SQUARE_LOWEST, FILM_SQUARE_STEP),
                                FILM_WORDS - 1u);
        PREFETCH(words + square * PIXEL_SUMS + 3);
    }
}

/// Adds a path's contribution to a pixel and returns whether the film accepted it. Counts a
/// rejected contribution as an error.
DEVICE bool add_to_pixel(FilmView film, uint pixel, Path path, float3 sample) {
    const uint error = film_add_sample(pixel_words(film, pixel, path), sample);
    if (error != 0u) {
        atomic_inc(error == FILM_NON_FINITE ? &film.counters->non_finite
                                            : &film.counters->out_of_range);
    }
    return error == 0u;
}
