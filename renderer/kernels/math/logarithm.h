// SPDX-License-Identifier: MIT
// Logarithms and powers of the densities in MIS weights, by polynomials as exact as the weights
// need.
#pragma once

#include "renderer/shared/compat.h"

/// log2(a / b) of densities, a >= 0 and b > 0, finite, without the quotient, which might leave the
/// range of float: off by 1.5e-7 and half an ulp of the result, relatively as exact where a is near
/// b. -INFINITY where a is below 2^-126, which counts as impossible; of b below that the result is
/// finite.
///
/// With n the mantissa of a and m that of b times 2 to the power that brings it within a factor
/// of 1.5 of n, this is the difference of their exponents + log2(n / m), and log2(n / m) = 2 / ln 2
/// artanh((n - m) / (n + m)), a least maximum polynomial; n - m is exact.
DEVICE float log2_quotient(float a, float b) {
    if (!(a >= 0x1p-126f)) {
        return -INFINITY;
    }
    const int exponent = ((int)as_uint(a) - (int)as_uint(b) + 0x400000) >> 23;
    const uint scale = (as_uint(a) & 0x7f800000u) - 0x3f800000u;
    const float n = as_float(as_uint(a) - scale);
    const float m = as_float(as_uint(b) + ((uint)exponent << 23) - scale);
    const float t = (n - m) / (n + m);
    const float t2 = t * t;
    return (float)exponent +
           t * fma(t2, fma(t2, fma(t2, 0.43914813f, 0.57639205f), 0.96180224f), 2.88539f);
}

/// log2 of a density, as above.
DEVICE float log2_of(float a) {
    return log2_quotient(a, 1.0f);
}

/// 2^x, off by 1e-7 of it for x in [-126, 127]; at most 2^-126 below, at least 2^127 above and
/// INFINITY from 127.5 on.
DEVICE float power_of_two(float x) {
    const float bounded = min(max(x, -127.0f), 128.0f);
    const float whole = (bounded + 0x1.8p23f) - 0x1.8p23f;  // the nearest integer
    const float f = bounded - whole;
    float p = fma(f, 0.00015469732f, 0.0013400433f);
    p = fma(f, p, 0.009618025f);
    p = fma(f, p, 0.05550327f);
    p = fma(f, p, 0.24022651f);
    p = fma(f, p, 0.6931472f);
    return fma(f, p, 1.0f) * as_float((uint)((int)whole + 127) << 23);
}
