// SPDX-License-Identifier: MIT
// Stage stop_converged: records the number of samples at which a live pixel has converged.
//
// One work-item per live pixel. Runs between batches, at the checks of convergence control.
// The carries of the film are propagated before, those of the half film here.
//
// STAGE(stop_converged,
//       reads(film, live_pixels),
//       writes(half_film, stopped_at))

#include "renderer/kernels/film/convergence.h"

__kernel void stop_converged(GLOBAL const long *film, GLOBAL long *half_film,
                             GLOBAL const uint *live_pixels, uint live_count,
                             GLOBAL ulong *stopped_at, float error, ulong samples) {
    const uint i = get_global_id(0);
    if (i >= live_count) {
        return;
    }
    const ulong pixel = live_pixels[i];
    GLOBAL long *half_words = half_film + pixel * HALF_FILM_PIXEL_WORDS;
    for (uint sum = 0; sum < HALF_FILM_SUMS; ++sum) {
        film_carry_sum(half_words, HALF_FILM_SUMS, sum, FILM_SUM_STEP);
    }
    const float3 all =
        film_colour_sum(film + pixel * PIXEL_WORDS, PIXEL_SUMS, FILM_GROUPS(FEATURE_sequences));
    if (has_converged(all, film_colour_sum(half_words, HALF_FILM_SUMS, 1u), error)) {
        stopped_at[pixel] = samples;
    }
}
