// SPDX-License-Identifier: MIT
// Stage carry_film: propagates the carries of the film's sums.
//
// One work-item per sum. Runs before a word of a sum could overflow, and before the sums are read.
//
// STAGE(carry_film,
//       writes(film))

#include "renderer/kernels/film/film.h"

__kernel void carry_film(GLOBAL long *film, uint sums) {
    const uint i = get_global_id(0);
    if (i >= sums) {
        return;
    }
    const ulong pixel = i / PIXEL_SUMS;
    const uint sum = i % PIXEL_SUMS;
    film_carry_sum(film + pixel * PIXEL_WORDS, PIXEL_SUMS, sum, film_step(sum, HOLDS_SQUARES));
}
