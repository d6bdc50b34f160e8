// SPDX-License-Identifier: MIT
// The film's exact sums. A sum is held in several 64-bit integers ("words") at staggered scales:
// word k counts multiples of 2^(lowest + k step). A float is added whole to the lowest word whose
// limit it does not reach, so it keeps its 24 bits there (rounded to nearest below the range, at
// 2^lowest) and the sum of any number of floats in any order is the same integer. Carries are moved
// up before a word could overflow, and before it is read.
//
//   radiance: limits 2^-60 2^-40 2^-20 1 2^20 2^40, units 2^-104 ... 2^-4; below 2^44 units per
//   addition, so
//             2^19 additions fit between two carries. A value of 2^40 or more is out of range:
//             counted, reported.
//   squares:  limits 2^-40 2^-16 2^8 2^32 2^56 2^80, units 2^-84 ... 2^36; below 2^44 units
//   likewise; the relative
//             rounding of one square of 2^-60 or more is at most 2^-21, at the bottom of a word.
#pragma once

#include "compat.h"

#define FILM_WORDS 6
#define FILM_CHANNELS 3

#define FILM_SUM_LOWEST (-104)
#define FILM_SUM_STEP 20
#define FILM_SQUARE_LOWEST (-84)
#define FILM_SQUARE_STEP 24

#define FILM_UNITS_PER_ADDITION 44                /* log2, exclusive */
#define FILM_ADDITIONS_BETWEEN_CARRIES (1u << 18) /* half of what fits */

/// Sums of one pixel: R, G, B, then their squares where they are kept.
#define FILM_PIXEL_SUMS(variance) (FILM_CHANNELS * ((variance) ? 2 : 1))

/// Words of one pixel. Word k of sum s is at k * FILM_PIXEL_SUMS + s: the sums of one magnitude,
/// which a sample adds to together, share a cache line.
#define FILM_PIXEL_WORDS(variance) (FILM_WORDS * FILM_PIXEL_SUMS(variance))

/// The same of the film of every other sample (kernels/film/convergence.h), which keeps no squares.
#define HALF_FILM_SUMS FILM_PIXEL_SUMS(0)
#define HALF_FILM_PIXEL_WORDS FILM_PIXEL_WORDS(0)

/// Moves what exceeds a word's own range up to the next, so that equal sums have equal words: all
/// but the top word end in [0, 2^step), the top word keeps the sign. `sum` numbers one of the
/// `sums` (FILM_PIXEL_SUMS) of the pixel.
DEVICE void film_carry_sum(GLOBAL long *pixel_words, uint sums, uint sum) {
    const int step = sum < FILM_CHANNELS ? FILM_SUM_STEP : FILM_SQUARE_STEP;
    for (uint word = 0; word + 1 < FILM_WORDS; ++word) {
        GLOBAL long *low = pixel_words + word * sums + sum;
        const long carry = *low >> step;  // arithmetic: rounds down
        *low -= carry * (1L << step);
        low[sums] += carry;
    }
}
