// SPDX-License-Identifier: MIT
// Stage carry_film: normalises the film's sums. One work-item per channel of a pixel and kind of sum.
// Reads and writes: film. Runs between batches.

#include "kernels/film/film.h"

__kernel void carry_film(GLOBAL long *film, uint sums) {
    const uint i = get_global_id(0);
    if (i >= sums) {
        return;
    }
#if FEATURE_variance
    const bool is_square = i % (2 * FILM_CHANNELS) >= FILM_CHANNELS;
#else
    const bool is_square = false;
#endif
    film_carry_value(film + (ulong)i * FILM_WORDS, is_square ? FILM_SQUARE_STEP : FILM_SUM_STEP);
}
