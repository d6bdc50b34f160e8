// SPDX-License-Identifier: MIT
// Owen-scrambled Sobol points in four dimensions (Sobol 1967; Owen 1995).
//
// Scrambling is by hashing (Burley 2020, "Practical hash-based Owen scrambling") with the hash of
// Vegdahl 2021. Any 2^k consecutive samples, from a multiple of 2^k on, are stratified in every
// dimension and pair of dimensions like the unscrambled sequence. Each scrambling is random, so
// estimates are unbiased. Further dimensions use sequences with independent scramblings and orders.
//
// All numbers are bit-reversed until the end: bit 0 is the most significant one. The scrambling
// then needs no reversal of its own, and the points need no tables of direction numbers. Those of a
// dimension, v_i, satisfy p(t) = r^e: p is its primitive polynomial, of degree e, t is the step
// from v_i to v_(i+1), and r the shift by one digit (Joe & Kuo 2008, equation 2). The index is a
// polynomial in t over GF(2). Digit j of this polynomial in base p therefore gives the digits of
// the point from e j on. The functions below divide by p^16, p^8, ..., p in place, in all parts of
// the word at once. The digits below e are those of the initial values m.
#pragma once

#include "renderer/shared/compat.h"

DEVICE_LANE uint reverse_bits(uint x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Reverses the bits of each word.
DEVICE_LANE uint4 reverse_all_bits(uint4 v) {
    return make_uint4(reverse_bits(v.x), reverse_bits(v.y), reverse_bits(v.z), reverse_bits(v.w));
}

/// Permutes the bit-reversed x at random so that every bit depends only on the more significant
/// ones, those below it: nested uniform scrambling in base 2.
DEVICE_LANE uint scramble_reversed(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

/// Returns dimension 2, bit-reversed, of the point whose index has the bits `v`: p = t + 1.
DEVICE_LANE uint sobol_dimension_2(uint v) {
    v ^= v >> 16;
    v ^= (v >> 8) & 0x00ff00ffu;
    v ^= (v >> 4) & 0x0f0f0f0fu;
    v ^= (v >> 2) & 0x33333333u;
    return v ^ ((v >> 1) & 0x55555555u);
}

/// Returns dimension 3, bit-reversed: p = t^2 + t + 1, m = 1, 3. A division by t^2q + t^q + 1
/// leaves the quotient in the upper half of each part, and the remainder in the lower half. The
/// last line replaces the digits of base p by those of v_0 and v_1.
DEVICE_LANE uint sobol_dimension_3(uint v) {
    v ^= (v >> 8) & 0x00ff0000u;
    v ^= (v >> 16) ^ ((v >> 8) & 0x0000ff00u);
    v ^= (v >> 4) & 0x0f000f00u;
    v ^= ((v >> 8) & 0x00ff00ffu) ^ ((v >> 4) & 0x00f000f0u);
    v ^= (v >> 2) & 0x30303030u;
    v ^= ((v >> 4) & 0x0f0f0f0fu) ^ ((v >> 2) & 0x0c0c0c0cu);
    v ^= (v >> 1) & 0x44444444u;
    v ^= ((v >> 2) & 0x33333333u) ^ ((v >> 1) & 0x22222222u);
    return v ^ ((v >> 1) & 0x55555555u);
}

/// Returns dimension 4, bit-reversed: p = t^3 + t + 1, m = 1, 3, 1. The parts have 24, 12, 6 and 3
/// bits; the word cuts off the last one.
DEVICE_LANE uint sobol_dimension_4(uint v) {
    v ^= (v >> 24) ^ ((v >> 16) & 0x0000ff00u);
    v ^= (v >> 8) & 0x0000f000u;
    v ^= ((v >> 12) & 0x00000fffu) ^ ((v >> 8) & 0x00000ff0u);
    v ^= (v >> 4) & 0x000c00c0u;
    v ^= ((v >> 6) & 0x3f03f03fu) ^ ((v >> 4) & 0x3c03c03cu);
    v ^= (v >> 2) & 0x08208208u;
    v ^= ((v >> 3) & 0xc71c71c7u) ^ ((v >> 2) & 0x86186186u);
    return v ^ ((v >> 1) & 0x49249249u);
}

/// Returns the point of the unscrambled sequence whose index has these bits. Its words are
/// bit-reversed.
DEVICE_LANE uint4 reversed_sobol_point(uint bits) {
    return make_uint4(bits, sobol_dimension_2(bits), sobol_dimension_3(bits),
                      sobol_dimension_4(bits));
}

/// Returns point `index` of a sequence. `order` determines the order of its points, `seeds` the
/// scramblings of the dimensions.
DEVICE_LANE uint4 sobol_point(uint index, uint order, uint4 seeds) {
    // The index is scrambled as a number whose lowest bit is the last one, so that any 2^k
    // consecutive points stay together.
    const uint4 point =
        reversed_sobol_point(reverse_bits(scramble_reversed(reverse_bits(index), order)));
    return reverse_all_bits(
        make_uint4(scramble_reversed(point.x, seeds.x), scramble_reversed(point.y, seeds.y),
                   scramble_reversed(point.z, seeds.z), scramble_reversed(point.w, seeds.w)));
}

/// Returns point `index` of a regular sequence: sobol_point with digital shifts of index and point,
/// which keep the stratification. Point 0 is (1/2, 1/2, 0, 1/2), the centre of a pixel and of the
/// lens.
DEVICE uint4 regular_point(uint index, uint order, uint4 seeds) {
    const uint4 point = reversed_sobol_point(
        reverse_bits(scramble_reversed(reverse_bits(index), order) ^ scramble_reversed(0u, order)));
    const uint one_half = 1u;  // the most significant bit
    return reverse_all_bits(make_uint4(
        scramble_reversed(point.x, seeds.x) ^ scramble_reversed(0u, seeds.x) ^ one_half,
        scramble_reversed(point.y, seeds.y) ^ scramble_reversed(0u, seeds.y) ^ one_half,
        scramble_reversed(point.z, seeds.z) ^ scramble_reversed(0u, seeds.z),
        scramble_reversed(point.w, seeds.w) ^ scramble_reversed(0u, seeds.w) ^ one_half));
}
