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
// Even and odd Sobol samples belong to different sequences (kernels/sampling/sampler.h), which are
// independent. The two means therefore differ by their errors, as those of independent samples do.
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

/// Returns the total of a channel's sums in `groups` groups, rounded to float. Their carries have
/// been propagated. The total is exact before it is rounded, so it does not depend on the groups.
/// Words are added from the top, as on the host (film/film.cpp).
DEVICE float film_total(GLOBAL const long *words, uint sums, uint groups) {
    long total[FILM_WORDS];
    long carry = 0;
    for (uint word = 0u; word < FILM_WORDS; ++word) {
        total[word] = carry;
        for (uint group = 0u; group < groups; ++group) {
            total[word] += words[word * sums + group * FILM_CHANNELS];
        }
        carry = word + 1u < FILM_WORDS ? total[word] >> FILM_SUM_STEP : 0;
        total[word] -= carry * (1L << FILM_SUM_STEP);
    }
    float value = 0.0f;
    for (uint above = FILM_WORDS; above > 0u; --above) {
        const uint word = above - 1u;
        const int unit = FILM_SUM_LOWEST + (int)word * FILM_SUM_STEP;
        value += (float)total[word] * as_float((uint)(127 + unit) << 23);
    }
    return value;
}

/// Returns the totals of a pixel's channels over `groups` groups of sums, rounded to float.
DEVICE float3 film_colour_sum(GLOBAL const long *pixel_words, uint sums, uint groups) {
    return make_float3(film_total(pixel_words, sums, groups),
                       film_total(pixel_words + 1, sums, groups),
                       film_total(pixel_words + 2, sums, groups));
}

/// Returns whether a pixel has converged, given the sum `all` of 2N samples and the sum `half_sum`
/// of N of them. The test is (3.57) times 2N: it has no division, and a black pixel does not pass.
DEVICE bool has_converged(float3 all, float3 half_sum, float error) {
    return length(all - 2.0f * half_sum) < 2.0f * error * length(half_sum);
}
