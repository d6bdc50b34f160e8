// SPDX-License-Identifier: MIT
// Stage carry_film: normalises the film's sums. One work-item per channel of a pixel and kind of
// sum. Reads and writes: film. Runs where the sums might leave their words, and before they are
// read.

#include "renderer/kernels/film/film.h"

__kernel void carry_film(GLOBAL long *film, uint sums) {
    const uint i = get_global_id(0);
    if (i >= sums) {
        return;
    }
    const ulong pixel = i / PIXEL_SUMS;
    film_carry_sum(film + pixel * FILM_PIXEL_WORDS(FEATURE_variance), PIXEL_SUMS, i % PIXEL_SUMS);
}
