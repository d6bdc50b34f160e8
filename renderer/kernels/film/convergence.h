// SPDX-License-Identifier: MIT
// Convergence control (thesis, section 3.3.7): the criterion by which a pixel has converged.
//
//   |I_2N - I_N| < error |I_N|    thesis (3.57), with the Euclidean norm over the channels (3.58)
//
// I_2N is the mean of all 2N samples of a pixel. I_N is the mean of the N samples of even index,
// which the half film accumulates. Any N of 2N independent samples are as good as the first N. The
// sum of the even samples is available at every check. The sums of first halves would have to be
// stored for all later checks. Dammertz et al. 2010, "A hierarchical automatic stopping condition
// for Monte Carlo global illumination", section 3, divide the samples in the same way.
//
// Sobol samples 2i and 2i + 1 are in different halves of every dimension. The means of the even and
// the odd samples therefore differ as those of independent samples do, and stratification does not
// stop pixels earlier.
//
// If I_N is black, which is 0/0 in the thesis, it says nothing about its error, however many
// samples there are. Such a pixel continues. Its paths usually leave the scene at once and cost
// little, but they may also have missed a light that few paths find.
#pragma once

#include "renderer/kernels/film/film.h"

/// Adds a sample that the film itself accepted to the half film if its index `number` is even.
/// Returns 0 or FILM_OUT_OF_RANGE.
DEVICE uint half_film_add_sample(volatile GLOBAL long *half_film, ulong pixel, ulong number,
                                 float3 sample) {
    const bool belongs = (number & 1u) == 0u;
    return belongs && film_add_colour(half_film + pixel * HALF_FILM_PIXEL_WORDS, HALF_FILM_SUMS,
                                      sample)
               ? FILM_OUT_OF_RANGE
               : 0u;
}

/// Returns a sum whose carries have been propagated, rounded to float. Words are added from the
/// top, as on the host (film/film.cpp).
DEVICE float film_sum(GLOBAL const long *words, uint sums) {
    float value = 0.0f;
    for (uint above = FILM_WORDS; above > 0u; --above) {
        const uint word = above - 1u;
        const int unit = FILM_SUM_LOWEST + (int)word * FILM_SUM_STEP;
        value += (float)words[word * sums] * as_float((uint)(127 + unit) << 23);
    }
    return value;
}

/// Returns the first three sums of a pixel, rounded to float.
DEVICE float3 film_colour_sum(GLOBAL const long *pixel_words, uint sums) {
    return make_float3(film_sum(pixel_words, sums), film_sum(pixel_words + 1, sums),
                       film_sum(pixel_words + 2, sums));
}

/// Returns whether a pixel has converged, given the sum `all` of 2N samples and the sum `half_sum`
/// of N of them. The test is (3.57) times 2N: it has no division, and a black pixel does not pass.
DEVICE bool has_converged(float3 all, float3 half_sum, float error) {
    return length(all - 2.0f * half_sum) < 2.0f * error * length(half_sum);
}
