// SPDX-License-Identifier: MIT
// The end of a path: the radiance of a camera path is added to the film.
#pragma once

#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/film/convergence.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/shared/path_state.h"

/// Adds the radiance of a camera path to the film. Returns whether the film accepted it.
DEVICE bool add_path(Path path, FilmView film) {
    return add_to_pixel(film, get_pixel(path), path, get_radiance(path));
}

/// Prefetches the film where a path will be added.
DEVICE void prefetch_film(Path path, FilmView film) {
    if (FEATURE_from_camera) {
        prefetch_pixel(film, get_pixel(path), path, get_radiance(path));
    }
}

/// Adds a path that ends to the film and, if its sample has an even index, to the half film. Light
/// paths add nothing. `half_film_words` is read only with FEATURE_convergence.
DEVICE void retire_path(Path path, FilmView film, GLOBAL long *half_film_words) {
    if (FEATURE_light_path_trials) {
        store_trials(path, (GLOBAL PathTrials *)film.words);
        return;
    }
    if (!FEATURE_from_camera || !add_path(path, film) || !FEATURE_convergence) {
        return;
    }
    if (half_film_add_sample(half_film_words, get_pixel(path), film.first_sample + get_sample(path),
                             get_radiance(path)) != 0u) {
        atomic_inc(&film.counters->out_of_range);
    }
}
