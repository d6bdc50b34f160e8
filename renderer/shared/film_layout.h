// SPDX-License-Identifier: MIT
// The layout of the film: exact sums that do not depend on the order of additions.
//
// A sum is stored in several 64-bit integers ("words") at staggered scales. Word k counts multiples
// of 2^(lowest + k step), its unit. A float is added as a whole to the lowest word whose limit it
// does not reach, rounded to a multiple of the unit. A radiance keeps all of its 24 bits; only
// values below the range are rounded, at 2^lowest. What a float adds depends on the float alone.
// Therefore the sum of any number of floats in any order is the same integer. The work-item whose
// addition fills a word moves its upper half to the next word. Before sums are read, carries are
// propagated so that equal sums have equal words.
//
// - Radiance: limits 2^-60 2^-40 2^-20 1 2^20 2^40, units 2^-104 ... 2^-4. One addition is below
//   2^44 units. A value of 2^40 or more is out of range; it is counted and reported.
// - Squares: limits 2^-40 2^-16 2^8 2^32 2^56 2^80, units 2^-84 ... 2^36. One addition is below
//   2^44 units. The relative rounding error of a square of 2^-60 or more is at most 2^-21, which is
//   reached at the lower end of a word's range.
#pragma once

#include "compat.h"
#include "integrator_settings.h"

#define FILM_WORDS 6
#define FILM_CHANNELS 3

#define FILM_SUM_LOWEST (-104)
#define FILM_SUM_STEP 20
#define FILM_SQUARE_LOWEST (-84)
#define FILM_SQUARE_STEP 24

#define FILM_UNITS_PER_ADDITION 44 /* log2, exclusive */

/// Largest number of additions of one launch to a pixel (film_add_units).
#define FILM_ADDITIONS_AT_ONCE (1u << 18)

/// Number of sums of one pixel: R, G, B, and whatever the variance of their mean follows from. For
/// independent samples these are the squares. For Sobol points (`sequences`) there are no squares;
/// instead each sequence has its own R, G, B.
#define FILM_PIXEL_SUMS(variance, sequences) \
    (FILM_CHANNELS * ((sequences) ? SOBOL_SEQUENCES : (variance) ? 2u : 1u))

/// Number of sums whose total is that of a channel. They are FILM_CHANNELS apart.
#define FILM_GROUPS(sequences) ((sequences) ? SOBOL_SEQUENCES : 1u)

/// Number of words of one pixel. Word k of sum s is at k * FILM_PIXEL_SUMS + s. The sums of one
/// magnitude, to which a sample adds together, thus share a cache line.
#define FILM_PIXEL_WORDS(variance, sequences) (FILM_WORDS * FILM_PIXEL_SUMS(variance, sequences))

/// Number of sums and words of a pixel of the half film, which holds every other sample
/// (kernels/film/convergence.h) and no squares.
#define HALF_FILM_SUMS FILM_PIXEL_SUMS(0, 0)
#define HALF_FILM_PIXEL_WORDS FILM_PIXEL_WORDS(0, 0)

/// Returns the step of sum `sum` of a pixel: that of squares, if the film keeps them, from the
/// fourth sum on.
DEVICE int film_step(uint sum, bool squares) {
    return squares && sum >= FILM_CHANNELS ? FILM_SQUARE_STEP : FILM_SUM_STEP;
}

/// Propagates the carries of one sum, so that equal sums have equal words. Afterwards all words
/// except the top one are in [0, 2^step), and the top word keeps the sign. `sum` is the index of
/// the sum among the pixel's `sums` (FILM_PIXEL_SUMS).
DEVICE void film_carry_sum(GLOBAL long *pixel_words, uint sums, uint sum, int step) {
    for (uint word = 0; word + 1 < FILM_WORDS; ++word) {
        GLOBAL long *low = pixel_words + word * sums + sum;
        const long carry = *low >> step;  // arithmetic shift: rounds down
        *low -= carry * (1L << step);
        low[sums] += carry;
    }
}
