// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/shared/compat.h"

/// ratio^beta, from 0 to infinity.
DEVICE float heuristic_power(float ratio, float beta) { return beta == 2.0f ? ratio * ratio : pow(ratio, beta); }

/// Weight of the power heuristic for the technique whose density the ratio is taken against:
/// 1 / (1 + (p_other / p_own)^beta) (Veach 1997, 9.2.2; thesis 2.57). The ratio may be 0 or infinite, the weight
/// then is 1 or 0; it is never NaN for densities that are not both 0 or both infinite.
DEVICE float power_heuristic(float other_over_own, float beta) {
    return 1.0f / (1.0f + heuristic_power(other_over_own, beta));
}

// Truncated bidirectional path tracing (thesis 2.70-2.79). The path x_0 ... x_k, x_0 on the lens and x_k on the light, is
// found by implicit paths (density p_I), explicit paths (p_E) and light paths joined to the camera (p_L, n_L of them per
// sample of every pixel). With P_1 = p_A(x_1), the density of one camera sample per pixel, p_wp per projected solid angle,
// p_o p_d the density per area and projected solid angle of what leaves the light, and E the density per area with which
// it arrives at x_{k-1}, k is 2 at least:
//
//   p_L / p_I = R_{k-1} p_o p_d,     R_0 = n_L / P_1,   R_1 = R_0 / p_wp(x_1 -> x_2),
//                                    R_i = R_{i-1} p_wp(x_i -> x_{i-1}) / p_wp(x_i -> x_{i+1})
//   p_L / p_E = R_{k-2} p_wp(x_{k-1} -> x_{k-2}) E p_o / p_o,explicit,   without p_wp for k = 2
//   p_E / p_I = density of light sampling at x_{k-1} / density of BSDF sampling there
//
// For k = 1, emitters seen directly, implicit paths alone count: within a pixel they have no noise but that of edges,
// while light paths would add theirs (on a visible sphere light: twice the error).
//
// A camera path keeps log2 R. A light path, which meets the same vertices the other way round, keeps from x_{k-1} on the
// log2 of S, what its vertices so far give of (p_I / p_L)^beta + (p_E / p_L)^beta. In logarithms nothing overflows or
// underflows however long the path; the error of a weight is some 1e-7 times the logarithm. What cannot happen has
// -INFINITY, and no other infinity is added to it: densities of directions that were drawn are positive and finite.

/// (2^x)^beta.
DEVICE float power_of(float log_ratio, float beta) { return exp2(beta * log_ratio); }

/// log2(2^x + 2^y), x and y below INFINITY.
DEVICE float log_sum(float x, float y) {
    const float larger = max(x, y);
    return larger > -INFINITY ? larger + log2(1.0f + exp2(min(x, y) - larger)) : larger;
}

/// The weight of an implicit or explicit path, given the density of the other over its own and log2 of p_L over its own.
DEVICE float camera_path_weight(float other_over_own, float log_light_over_own, float beta) {
    return 1.0f / (1.0f + heuristic_power(other_over_own, beta) + power_of(log_light_over_own, beta));
}

/// log2 of R_i from that of R_{i-1}, i = `depth` + 1. At x_i the path is scattered with density p_wp(x_i -> x_{i+1}), log2
/// `log_forward`; `log_back` is log2 of p_wp(x_i -> x_{i-1}) over it (bsdf/reverse.h).
DEVICE float continue_camera_ratio(float log_ratio, uint depth, bool is_delta, float log_forward, float log_back) {
    if (depth == 0u) {
        return is_delta ? -INFINITY : log_ratio - log_forward;  // light paths cannot be joined to the camera at a delta
    }
    return log_ratio + log_back;
}

/// log2 of S beyond the vertex at which a light path is scattered, as above, after `depth` vertices before. Before the
/// first, x_{k-1}, `log_ratio` is log2 of 1 / (p_o p_d), -INFINITY where the light cannot be hit, and `log_explicit` that
/// of p_o,explicit / (p_o E).
DEVICE float continue_light_ratio(float log_ratio, float log_explicit, uint depth, bool is_delta, float log_forward,
                                  float log_back, float beta) {
    if (depth == 0u) {
        // At a delta there is no joining to a light.
        return log_sum(beta * (log_ratio + log_back), is_delta ? -INFINITY : beta * (log_explicit - log_forward));
    }
    return log_ratio + beta * log_back;
}

/// The weight of a light path that is joined to the camera at x_1: `log_back` is log2 of p_wp(x_1 -> x_2), `log_first` of
/// P_1 / n_L; the others as above.
DEVICE float light_path_weight(float log_ratio, float log_explicit, uint depth, float log_back, float log_first,
                               float beta) {
    const float others = depth == 0u ? power_of(log_ratio + log_back + log_first, beta) +
                                           power_of(log_explicit + log_first, beta)
                                     : exp2(log_ratio + beta * (log_back + log_first));
    return 1.0f / (1.0f + others);
}
