// SPDX-License-Identifier: MIT
// Adds samples to the film's exact sums (shared/film_layout.h). The order of additions does not
// matter.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/film_layout.h"

#if defined(__OPENCL_VERSION__) && FEATURE_int64_atomics
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#endif

/// Returns whether a word with this upper half is outside [-2^61, 2^61).
DEVICE bool film_is_filling(int high) {
    return high >= (1 << 29) || high < -(1 << 29);
}

/// Adds to a 64-bit word. If this takes the word out of [-2^61, 2^61), returns its upper half,
/// otherwise 0. Of work-items that add at once, the one that does so is told. Without 64-bit
/// atomics the halves are added one after the other. The sum is then right once all additions are
/// done, which is sufficient for the film.
DEVICE int film_add_word(volatile GLOBAL long *word, long value) {
#if FEATURE_int64_atomics
    const long before = atom_add(word, value);
    const int high_before = (int)(before >> 32);
    const int high = (int)((long)((ulong)before + (ulong)value) >> 32);
#else
    // Assumes little-endian words, which all OpenCL devices tested so far have.
    volatile GLOBAL uint *half_word = (volatile GLOBAL uint *)word;
    const uint low = (uint)value;
    const uint before = atomic_add(half_word, low);
    const uint carry = before + low < before ? 1u : 0u;
    const uint upper = (uint)((ulong)value >> 32) + carry;
    const uint upper_before = atomic_add(half_word + 1, upper);
    const int high_before = (int)upper_before;
    const int high = (int)(upper_before + upper);
#endif
    return film_is_filling(high) && !film_is_filling(high_before) ? high : 0;
}

/// Adds units to a word of a sum. The work-item that fills the word moves its upper half to the
/// next word, and so on. Meanwhile others may add: up to FILM_ADDITIONS_AT_ONCE of less than 2^44
/// units, which 2^61 and the carries from below leave room for in 63 bits. Returns whether the sum
/// leaves its range.
DEVICE bool film_add_units(volatile GLOBAL long *words, uint sums, uint word, long units,
                           int step) {
    int high = film_add_word(words + word * sums, units);
    for (; high != 0; ++word) {
        if (word + 1u == FILM_WORDS) {
            return true;
        }
        units = 0;
        while (high != 0) {
            units += high * (1L << (32 - step));
            high = film_add_word(words + word * sums, -(high * (1L << 32)));
        }
        high = film_add_word(words + (word + 1u) * sums, units);
    }
    return false;
}

#define PIXEL_SUMS FILM_PIXEL_SUMS(FEATURE_variance, FEATURE_sequences)
#define PIXEL_WORDS FILM_PIXEL_WORDS(FEATURE_variance, FEATURE_sequences)
#define HOLDS_SQUARES (FEATURE_variance && !FEATURE_sequences)

/// Returns the index of the word for the magnitude of a value.
DEVICE uint film_word(float value, int lowest, int step) {
    // |value| < 2^exponent. The bits give the exponent exactly, unlike log2; 0 and denormals give
    // -126.
    const int exponent = (int)((as_uint(value) >> 23) & 0xffu) - 126;
    const int above = exponent - (lowest + FILM_UNITS_PER_ADDITION);
    return above <= 0 ? 0u : (uint)((above + step - 1) / step);
}

/// Adds `value` as a whole to the word for its magnitude. Word 0 of the sum is at `words`, in a
/// pixel of `sums` sums. The magnitude of `value` must be below the largest limit, 2^(lowest + 5
/// step + 44). Returns whether the sum leaves its range.
DEVICE bool film_add_value(volatile GLOBAL long *words, uint sums, float value, int lowest,
                           int step) {
    const uint word = film_word(value, lowest, step);
    // The factor 2^-unit is a normal float: |unit| <= 104.
    const float units = value * as_float((uint)(127 - (lowest + (int)word * step)) << 23);
    // Below 2^23 a float may have a fraction and is rounded to nearest; above it is an integer.
    return film_add_units(words, sums, word, (long)(fabs(units) < 8388608.0f ? rint(units) : units),
                          step);
}

/// Adds a colour within the film's range to the first three sums of a pixel. Returns whether a sum
/// leaves its range.
DEVICE bool film_add_colour(volatile GLOBAL long *pixel_words, uint sums, float3 colour) {
    bool beyond = film_add_value(pixel_words, sums, colour.x, FILM_SUM_LOWEST, FILM_SUM_STEP);
    beyond |= film_add_value(pixel_words + 1, sums, colour.y, FILM_SUM_LOWEST, FILM_SUM_STEP);
    beyond |= film_add_value(pixel_words + 2, sums, colour.z, FILM_SUM_LOWEST, FILM_SUM_STEP);
    return beyond;
}

#define FILM_NON_FINITE 1u
#define FILM_OUT_OF_RANGE 2u

/// Adds one sample to a pixel, and its squares if the film keeps them. Returns 0, FILM_NON_FINITE
/// or FILM_OUT_OF_RANGE. An error means that the sample was not added, or that a sum is about to
/// leave its range.
DEVICE uint film_add_sample(volatile GLOBAL long *pixel_words, float3 sample) {
    if (!(isfinite(sample.x) && isfinite(sample.y) && isfinite(sample.z))) {
        return FILM_NON_FINITE;
    }
    const float limit = 0x1p40f;
    if (!(fabs(sample.x) < limit && fabs(sample.y) < limit && fabs(sample.z) < limit)) {
        return FILM_OUT_OF_RANGE;
    }
    bool beyond = film_add_colour(pixel_words, PIXEL_SUMS, sample);
    if (HOLDS_SQUARES) {
        // Squares stay below 2^80, the limit of their top word.
        beyond |= film_add_value(pixel_words + 3, PIXEL_SUMS, sample.x * sample.x,
                                 FILM_SQUARE_LOWEST, FILM_SQUARE_STEP);
        beyond |= film_add_value(pixel_words + 4, PIXEL_SUMS, sample.y * sample.y,
                                 FILM_SQUARE_LOWEST, FILM_SQUARE_STEP);
        beyond |= film_add_value(pixel_words + 5, PIXEL_SUMS, sample.z * sample.z,
                                 FILM_SQUARE_LOWEST, FILM_SQUARE_STEP);
    }
    return beyond ? FILM_OUT_OF_RANGE : 0u;
}
