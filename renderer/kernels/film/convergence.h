// SPDX-License-Identifier: MIT
// Convergence control (thesis 3.3.7): when a pixel has converged,
//
//   |I_2N - I_N| < error |I_N|    thesis (3.57), with the Euclidean norm over the channels (3.58).
//
// I_2N is the mean of all 2N samples of a pixel, I_N that of the N of even number, which a film of
// their own holds: any N of independent samples are as good as the first, and their sum is there at
// every check, where first halves would have to be kept for all checks to come (Dammertz et al.
// 2010, "A hierarchical automatic stopping condition for Monte Carlo global illumination", 3, halve
// likewise). Sobol samples 2i and 2i + 1 lie in different halves of every dimension: their means
// differ as those of independent samples do, so that pixels stop no sooner for being stratified.
//
// A black I_N, 0/0 in the thesis, says nothing of its error, however many samples it has: such a
// pixel goes on. Most often its paths leave the scene at once and cost little; but it may also have
// missed a light that few paths find.
#pragma once

#include "renderer/kernels/film/film.h"

/// Adds a sample, which the film itself took, to the half film where it belongs there. Returns 0 or
/// FILM_OUT_OF_RANGE.
DEVICE uint half_film_add_sample(volatile GLOBAL long *half_film, ulong pixel, ulong number,
                                 float3 sample) {
    const bool belongs = (number & 1u) == 0u;
    return belongs && film_add_colour(half_film + pixel * HALF_FILM_PIXEL_WORDS, HALF_FILM_SUMS,
                                      sample)
               ? FILM_OUT_OF_RANGE
               : 0u;
}

/// One carried sum, rounded to float: added from the top, as on the host (pipeline/film.cpp).
DEVICE float film_sum(GLOBAL const long *words, uint sums) {
    float value = 0.0f;
    for (uint above = FILM_WORDS; above > 0u; --above) {
        const uint word = above - 1u;
        const int unit = FILM_SUM_LOWEST + (int)word * FILM_SUM_STEP;
        value += (float)words[word * sums] * as_float((uint)(127 + unit) << 23);
    }
    return value;
}

DEVICE float3 film_colour_sum(GLOBAL const long *pixel_words, uint sums) {
    return make_float3(film_sum(pixel_words, sums), film_sum(pixel_words + 1, sums),
                       film_sum(pixel_words + 2, sums));
}

/// `all`: sum of 2N samples, `half_sum`: of N of them. (3.57) times 2N: nothing is divided by, and
/// black is not below black.
DEVICE bool has_converged(float3 all, float3 half_sum, float error) {
    return length(all - 2.0f * half_sum) < 2.0f * error * length(half_sum);
}
