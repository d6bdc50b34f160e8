// SPDX-License-Identifier: MIT
// The power heuristic of multiple importance sampling (MIS), and the arithmetic of densities that
// are stored as logarithms.
//
// A path can be sampled by several strategies. Strategy i has density p_i and the weight
//
//   w_i = 1 / sum over j of (p_j / p_i)^beta                                           MIS (1)
//
// Only ratios of densities occur, so their common measure cancels. MIS (n) is equation (n) of
// docs/mis-weights.md. Here and in truncated.h and bidirectional.h:
//
//   own         p_i, the density of the strategy that sampled the path
//   other       p_j, the density of another strategy for the same path
//   beta        exponent of the heuristic, integrator.beta
//   log_...     base-2 logarithm; -INFINITY stands for the density of an impossible event
//
// Products of many ratios leave the range of float, their logarithms do not. The error of a weight
// is about 1e-7 times the logarithm. -INFINITY is never added to +INFINITY, since densities of
// sampled directions are positive and finite.
#pragma once

#include "renderer/kernels/math/logarithm.h"
#include "renderer/shared/compat.h"

/// Returns ratio^beta, for a ratio from 0 to infinity.
DEVICE float heuristic_power(float ratio, float beta) {
    return beta == 2.0f ? ratio * ratio : pow(ratio, beta);
}

/// Returns (2^log_ratio)^beta.
DEVICE float power_of(float log_ratio, float beta) {
    return power_of_two(beta * log_ratio);
}

/// Returns log2(2^x + 2^y), for x and y below INFINITY.
DEVICE float log_sum(float x, float y) {
    const float larger = max(x, y);
    return larger > -INFINITY ? larger + log2_of(1.0f + power_of_two(min(x, y) - larger)) : larger;
}

/// Returns the weight of one of two strategies, with p_other / p_own (Veach 1997, section 9.2.3;
/// thesis (2.58)). The ratio may be 0 or infinite; the weight is then 1 or 0. It is never NaN
/// unless both densities are 0 or both infinite.
DEVICE float power_heuristic(float other_over_own, float beta) {
    return 1.0f / (1.0f + heuristic_power(other_over_own, beta));  // MIS (1), (8)
}

/// Returns the weight of one of two strategies, with log2 of p_other / p_own.
DEVICE float power_heuristic_of_log(float log_other_over_own, float beta) {
    return 1.0f / (1.0f + power_of(log_other_over_own, beta));  // MIS (1)
}
