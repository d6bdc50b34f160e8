// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/kernels/math/logarithm.h"
#include "renderer/shared/compat.h"

/// ratio^beta, from 0 to infinity.
DEVICE float heuristic_power(float ratio, float beta) {
    return beta == 2.0f ? ratio * ratio : pow(ratio, beta);
}

/// Weight of the power heuristic for the technique whose density the ratio is taken against:
/// 1 / (1 + (p_other / p_own)^beta) (Veach 1997, 9.2.2; thesis 2.57). The ratio may be 0 or
/// infinite, the weight then is 1 or 0; it is never NaN for densities that are not both 0 or both
/// infinite.
DEVICE float power_heuristic(float other_over_own, float beta) {
    return 1.0f / (1.0f + heuristic_power(other_over_own, beta));
}

// Truncated bidirectional path tracing (thesis 2.70-2.79). The path x_0 ... x_k, x_0 on the lens
// and x_k on the light, is found by implicit paths (density p_I), explicit paths (p_E) and light
// paths joined to the camera (p_L, n_L of them per sample of every pixel). With P_1 = p_A(x_1), the
// density of one camera sample per pixel, p_wp per projected solid angle, p_o p_d the density per
// area and projected solid angle of what leaves the light, and E the density per area with which it
// arrives at x_{k-1}, k is 2 at least:
//
//   p_L / p_I = R_{k-1} p_o p_d,     R_0 = n_L / P_1,   R_1 = R_0 / p_wp(x_1 -> x_2),
//                                    R_i = R_{i-1} p_wp(x_i -> x_{i-1}) / p_wp(x_i -> x_{i+1})
//   p_L / p_E = R_{k-2} p_wp(x_{k-1} -> x_{k-2}) E p_o / p_o,explicit,   without p_wp for k = 2
//   p_E / p_I = density of light sampling at x_{k-1} / density of BSDF sampling there
//
// For k = 1, emitters seen directly, p_L / p_I = R_0 p_o and p_E = 0, unless camera paths alone
// count: those find the emitter without noise but at its edges, light paths find the edges, too,
// but add noise inside. Which is better depends on the scene: with both, the error of the Cornell
// box is about half, that of features/sphere_light twice as large.
//
// A camera path keeps log2 R. A light path, which meets the same vertices the other way round,
// keeps from x_{k-1} on the log2 of S, what its vertices so far give of (p_I / p_L)^beta + (p_E /
// p_L)^beta. In logarithms nothing overflows or underflows however long the path; the error of a
// weight is some 1e-7 times the logarithm. What cannot happen has -INFINITY, and no other infinity
// is added to it: densities of directions that were drawn are positive and finite.

// Full bidirectional path tracing adds the strategies that join the camera path's x_m to the light
// path's x_{m+1}, m = 1
// ... k - 2 (Veach 1997, 10.2). A path from either end keeps two numbers for them (Georgiev 2012,
// "Implementing vertex connection and merging", dVCM and dVC), as logarithms: where it has arrived
// at vertex i with the density E_i per area,
//
//   A_i = 1 / E_i, the strategy that would have joined both ends of the ray rather than trace it;
//   n_L / P_1 on the camera's
//         first hit, p_o,explicit / (p_o E) on the light's; 0 where the vertex before had a delta
//         event
//   S_i = all strategies with i on the other side: S_i^beta = (A_i^beta + p_wp(i -> i-1)^beta
//   S_{i-1}^beta) /
//         p_wp(i -> i+1)^beta, without A_i at a delta; S_0 = 0 on the camera, 1 / (p_o p_d) on the
//         light, 0 if that cannot be hit
//
// so that p_others / p_own = p_arrive (A^beta + p_wp(back)^beta S^beta)^(1 / beta) is what one side
// of a join adds, p_arrive being the density per area with which the other side's path would have
// come here. With R in place of S, and A only of the first hits, these are the weights above.
// Vertices are kept of light paths up to a number N: strategies that join them exist for paths of
// at most N + 1 scattering events, all of them; longer paths are left to the three above, so that
// none is lost.

/// (2^x)^beta.
DEVICE float power_of(float log_ratio, float beta) {
    return power_of_two(beta * log_ratio);
}

/// log2(2^x + 2^y), x and y below INFINITY.
DEVICE float log_sum(float x, float y) {
    const float larger = max(x, y);
    return larger > -INFINITY ? larger + log2_of(1.0f + power_of_two(min(x, y) - larger)) : larger;
}

/// The weight of an implicit or explicit path, given the density of the other over its own and log2
/// of p_L over its own.
DEVICE float camera_path_weight(float other_over_own, float log_light_over_own, float beta) {
    return 1.0f /
           (1.0f + heuristic_power(other_over_own, beta) + power_of(log_light_over_own, beta));
}

/// log2 of R_i from that of R_{i-1}, i = `depth` + 1. At x_i the path is scattered with density
/// p_wp(x_i -> x_{i+1}), log2 `log_forward`; `log_back` is log2 of p_wp(x_i -> x_{i-1}) over it
/// (bsdf/reverse.h).
DEVICE float continue_camera_ratio(float log_ratio, uint depth, bool is_delta, float log_forward,
                                   float log_back) {
    if (depth == 0u) {
        return is_delta ? -INFINITY
                        : log_ratio -
                              log_forward;  // light paths cannot be joined to the camera at a delta
    }
    return log_ratio + log_back;
}

/// log2 of S beyond the vertex at which a light path is scattered, as above, after `depth` vertices
/// before. Before the first, x_{k-1}, `log_ratio` is log2 of 1 / (p_o p_d), -INFINITY where the
/// light cannot be hit, and `log_explicit` that of p_o,explicit / (p_o E).
DEVICE float continue_light_ratio(float log_ratio, float log_explicit, uint depth, bool is_delta,
                                  float log_forward, float log_back, float beta) {
    if (depth == 0u) {
        // At a delta there is no joining to a light.
        return log_sum(beta * (log_ratio + log_back),
                       is_delta ? -INFINITY : beta * (log_explicit - log_forward));
    }
    return log_ratio + beta * log_back;
}

/// The weight of a light path that is joined to the camera at x_1: `log_back` is log2 of p_wp(x_1
/// -> x_2), `log_first` of P_1 / n_L; the others as above.
DEVICE float light_path_weight(float log_ratio, float log_explicit, uint depth, float log_back,
                               float log_first, float beta) {
    const float others = depth == 0u ? power_of(log_ratio + log_back + log_first, beta) +
                                           power_of(log_explicit + log_first, beta)
                                     : power_of_two(log_ratio + beta * (log_back + log_first));
    return 1.0f / (1.0f + others);
}

/// log2 of (2^(beta x) + 2^(beta y))^(1 / beta).
DEVICE float log_norm(float x, float y, float beta) {
    return log_sum(beta * x, beta * y) / beta;
}

/// log2 of 1 / E of a hit after a way of that square, under that cosine, in a direction of density
/// `pdf_w` per solid angle: -INFINITY after a delta event, and for a hit in the plane of the
/// surface, which is none in exact arithmetic.
DEVICE float log_inverse_pdf_a(float pdf_w, float cosine, float squared) {
    return pdf_w < INFINITY && cosine > 0.0f ? log2_quotient(squared, cosine * pdf_w) : -INFINITY;
}

/// log2 of S_i from that of S_{i-1} and of A_i; the others as above.
DEVICE float continue_strategies(float log_strategies, float log_arrival, bool is_delta,
                                 float log_forward, float log_back, float beta) {
    return log_norm(log_strategies + log_back, is_delta ? -INFINITY : log_arrival - log_forward,
                    beta);
}

/// log2 of (A^beta + p^beta S^beta)^(1 / beta): the strategies on this side of a vertex that is
/// joined, `log_pdf` being log2 of p, the density per projected solid angle of going back from
/// there.
DEVICE float strategies_before(float log_strategies, float log_arrival, float log_pdf, float beta) {
    return log_norm(log_arrival, log_pdf + log_strategies, beta);
}

/// The weight of the join of two vertices, given log2 of what either side adds to p_others / p_own.
DEVICE float join_weight(float log_camera_side, float log_light_side, float beta) {
    return 1.0f / (1.0f + power_of(log_camera_side, beta) + power_of(log_light_side, beta));
}
