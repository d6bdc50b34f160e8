// SPDX-License-Identifier: MIT
// Adds samples to the film's exact sums (shared/film_layout.h). The order of additions does not
// matter.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/film_layout.h"

#if defined(__OPENCL_VERSION__) && FEATURE_int64_atomics
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#endif

/// Adds to a 64-bit word. Returns whether the word is half full, 2^18 additions before it could
/// overflow. Without 64-bit atomics the halves are added one after the other. The sum is then right
/// once all additions are done, which is sufficient for the film. Carries are propagated earlier
/// than that, so a half-full word is the top word of a sum that nears its limit.
DEVICE bool film_add_word(volatile GLOBAL long *word, long value) {
#if FEATURE_int64_atomics
    const int high = (int)(atom_add(word, value) >> 32);
#else
    // Assumes little-endian words, which all OpenCL devices tested so far have.
    volatile GLOBAL uint *half_word = (volatile GLOBAL uint *)word;
    const uint low = (uint)value;
    const uint before = atomic_add(half_word, low);
    const uint carry = before + low < before ? 1u : 0u;
    const int high = (int)atomic_add(half_word + 1, (uint)((ulong)value >> 32) + carry);
#endif
    return high >= (1 << 30) || high < -(1 << 30);
}

#define PIXEL_SUMS FILM_PIXEL_SUMS(FEATURE_variance)

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
/// step + 44). Returns whether the word is half full.
DEVICE bool film_add_value(volatile GLOBAL long *words, uint sums, float value, int lowest,
                           int step) {
    const uint word = film_word(value, lowest, step);
    // The factor 2^-unit is a normal float: |unit| <= 104.
    const float units = value * as_float((uint)(127 - (lowest + (int)word * step)) << 23);
    // Below 2^23 a float may have a fraction and is rounded to nearest; above it is an integer.
    return film_add_word(words + word * sums,
                         (long)(fabs(units) < 8388608.0f ? rint(units) : units));
}

/// Adds a colour within the film's range to the first three sums of a pixel. Returns whether a word
/// is half full.
DEVICE bool film_add_colour(volatile GLOBAL long *pixel_words, uint sums, float3 colour) {
    bool full = film_add_value(pixel_words, sums, colour.x, FILM_SUM_LOWEST, FILM_SUM_STEP);
    full |= film_add_value(pixel_words + 1, sums, colour.y, FILM_SUM_LOWEST, FILM_SUM_STEP);
    full |= film_add_value(pixel_words + 2, sums, colour.z, FILM_SUM_LOWEST, FILM_SUM_STEP);
    return full;
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
    bool full = film_add_colour(pixel_words, PIXEL_SUMS, sample);
    if (FEATURE_variance) {
        // Squares stay below 2^80, the limit of their top word.
        full |= film_add_value(pixel_words + 3, PIXEL_SUMS, sample.x * sample.x, FILM_SQUARE_LOWEST,
                               FILM_SQUARE_STEP);
        full |= film_add_value(pixel_words + 4, PIXEL_SUMS, sample.y * sample.y, FILM_SQUARE_LOWEST,
                               FILM_SQUARE_STEP);
        full |= film_add_value(pixel_words + 5, PIXEL_SUMS, sample.z * sample.z, FILM_SQUARE_LOWEST,
                               FILM_SQUARE_STEP);
    }
    return full ? FILM_OUT_OF_RANGE : 0u;
}
