// SPDX-License-Identifier: MIT
// Points on the unit circle by polynomials.
#pragma once

#include "renderer/shared/compat.h"

/// Returns (cos 2 pi v, sin 2 pi v) for v in [0, 2). The error of each is at most 8.6e-8; multiples
/// of 1/4 are exact.
///
/// The function reduces v to the nearest multiple of a quarter turn and evaluates minimax
/// polynomials on an eighth of a turn. Masks select the quarter. For random numbers it is random,
/// and a processor mispredicts the branches of a library's sinpi and cospi.
DEVICE float2 point_on_circle(float v) {
    const uint quarter = (uint)(4.0f * v + 0.5f);
    const float r = v - 0.25f * (float)quarter;  // exact
    const float r2 = r * r;
    const float s = r * fma(r2, fma(r2, fma(r2, -75.40184f, 81.592545f), -41.341663f), 6.2831855f);
    const float c =
        fma(r2, fma(r2, fma(r2, fma(r2, 59.424484f, -85.44883f), 64.93937f), -19.739208f), 1.0f);
    const uint odd = 0u - (quarter & 1u);
    const uint x = (as_uint(c) & ~odd) | (as_uint(s) & odd),
               y = (as_uint(s) & ~odd) | (as_uint(c) & odd);
    return make_float2(as_float(x ^ (((quarter + 1u) & 2u) << 30)),
                       as_float(y ^ ((quarter & 2u) << 30)));
}
