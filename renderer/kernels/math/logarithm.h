// SPDX-License-Identifier: MIT
// Logarithms and powers of the densities in MIS weights, by polynomials of the accuracy that the
// weights require.
#pragma once

#include "renderer/shared/compat.h"

/// Returns log2(a / b) for finite densities a >= 0 and b > 0, without forming the quotient, which
/// might leave the range of float. The error is at most 1.5e-7 plus half an ulp of the result; the
/// relative accuracy is kept where a is near b. Returns -INFINITY for a below 2^-126, which counts
/// as impossible. For b below 2^-126 the result is finite.
///
/// Let n be the mantissa of a, and m that of b times the power of 2 that brings it within a factor
/// of 1.5 of n. The result is the difference of their exponents + log2(n / m), with log2(n / m) =
/// 2 / ln 2 artanh((n - m) / (n + m)) by a minimax polynomial; n - m is exact.
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

/// Returns log2 of a density, with the accuracy and range of log2_quotient.
DEVICE float log2_of(float a) {
    return log2_quotient(a, 1.0f);
}

/// Returns 2^x, with a relative error of 1e-7 for x in [-126, 127]. The result is at most 2^-126
/// for smaller x, at least 2^127 for larger x, and INFINITY from 127.5 on.
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
