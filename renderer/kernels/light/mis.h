// SPDX-License-Identifier: MIT
// Weights of multiple importance sampling (MIS) for path tracing, truncated and full bidirectional
// path tracing.
#pragma once

#include "renderer/kernels/math/logarithm.h"
#include "renderer/shared/compat.h"

/// Returns ratio^beta, for a ratio from 0 to infinity.
DEVICE float heuristic_power(float ratio, float beta) {
    return beta == 2.0f ? ratio * ratio : pow(ratio, beta);
}

/// Returns the weight of the power heuristic, 1 / (1 + (p_other / p_own)^beta) (Veach 1997, section
/// 9.2.3; thesis (2.58)). The ratio may be 0 or infinite; the weight is then 1 or 0. It is never
/// NaN unless both densities are 0 or both infinite.
DEVICE float power_heuristic(float other_over_own, float beta) {
    return 1.0f / (1.0f + heuristic_power(other_over_own, beta));
}

// Truncated bidirectional path tracing (thesis (2.70)-(2.79)).
//
// A path x_0 ... x_k, with x_0 on the lens and x_k on the light, is sampled by three techniques:
// - An implicit path, with density p_I: the camera path hits the light.
// - An explicit path, with density p_E: the camera path is connected to a light sample.
// - A light path, with density p_L: it is connected to the camera. There are n_L light paths for
//   one camera sample of every pixel.
//
// The weights use these densities:
// - P_1 is the density per area of x_1 for one camera sample per pixel.
// - p_wp is a density per projected solid angle.
// - p_o p_d is the density per area and projected solid angle of the ray that leaves the light.
// - p_o,explicit is the density per area with which light sampling samples x_k.
// - E is the density per area with which the ray from the light arrives at x_{k-1}.
//
// For k >= 2 the ratios are
//
//   p_L / p_I = R_{k-1} p_o p_d
//     with R_0 = n_L / P_1
//          R_1 = R_0 / p_wp(x_1 -> x_2)
//          R_i = R_{i-1} p_wp(x_i -> x_{i-1}) / p_wp(x_i -> x_{i+1})
//   p_L / p_E = R_{k-2} p_wp(x_{k-1} -> x_{k-2}) E p_o / p_o,explicit   (without p_wp for k = 2)
//   p_E / p_I = density of light sampling at x_{k-1} / density of BSDF sampling there
//
// For k = 1, emitters seen directly, p_L / p_I = R_0 p_o and p_E = 0, if light paths show them.
// Otherwise only camera paths show them, without noise except at the edges of the emitter. Light
// paths also find the edges, but add noise inside. Which is better depends on the scene: with both,
// the error of the Cornell box is about half, and that of features/sphere_light twice as large.
//
// A camera path stores log2 R. A light path meets the same vertices in reverse order. From x_{k-1}
// on it stores log2 Q, where Q is the contribution of its vertices so far to (p_I / p_L)^beta +
// (p_E / p_L)^beta. Logarithms neither overflow nor underflow, however long the path. The error of
// a weight is about 1e-7 times the logarithm. Impossible events have the logarithm -INFINITY. It is
// never added to +INFINITY, since the densities of sampled directions are positive and finite.

// Full bidirectional path tracing adds the strategies that connect vertex x_m of the camera path to
// vertex x_{m+1} of the light path, m = 1 ... k - 2 (Veach 1997, section 10.2).
//
// A path from either end stores two values for them, as logarithms (Georgiev 2012, "Implementing
// vertex connection and merging": dVCM and dVC). Let E_i be the density per area with which the
// path has arrived at vertex i.
//
// A_i represents the strategy that connects both ends of the last ray instead of tracing it:
//
//   A_i = 1 / E_i
//   A_i = n_L / P_1              at the first hit of a camera path
//   A_i = p_o,explicit / (p_o E) at the first hit of a light path
//   A_i = 0                      if the previous vertex had a delta event
//
// S_i represents all strategies in which vertex i is on the path from the other end:
//
//   S_i^beta = (A_i^beta + p_wp(i -> i-1)^beta S_{i-1}^beta) / p_wp(i -> i+1)^beta
//     without A_i at a delta event
//   S_0 = 0                      on the camera
//   S_0 = 1 / (p_o p_d)          on the light, or 0 if the light cannot be hit
//
// One side of a connection thus contributes to p_others / p_own
//
//   p_arrive (A^beta + p_wp(back)^beta S^beta)^(1 / beta)
//
// where p_arrive is the density per area with which the path of the other side would have arrived
// here. With R in place of S, and A at the first hits only, these are the weights of truncated
// bidirectional path tracing.
//
// At most N vertices of a light path are stored. All strategies that connect them exist for paths
// of at most N + 1 scattering events. Longer paths are sampled by the three techniques above only,
// so that none is lost.

/// Returns (2^log_ratio)^beta.
DEVICE float power_of(float log_ratio, float beta) {
    return power_of_two(beta * log_ratio);
}

/// Returns log2(2^x + 2^y), for x and y below INFINITY.
DEVICE float log_sum(float x, float y) {
    const float larger = max(x, y);
    return larger > -INFINITY ? larger + log2_of(1.0f + power_of_two(min(x, y) - larger)) : larger;
}

/// Returns the weight of an implicit or explicit path. `other_over_own` is the ratio of the other's
/// density to its own, `log_light_over_own` is log2 of the ratio of p_L to its own density.
DEVICE float camera_path_weight(float other_over_own, float log_light_over_own, float beta) {
    return 1.0f /
           (1.0f + heuristic_power(other_over_own, beta) + power_of(log_light_over_own, beta));
}

/// Returns log2 of R_i, given that of R_{i-1}, with i = `depth` + 1. `log_forward` is log2 of the
/// density p_wp(x_i -> x_{i+1}) with which the path is scattered at x_i. `log_back` is log2 of
/// p_wp(x_i -> x_{i-1}) over that density (bsdf/reverse.h).
DEVICE float continue_camera_ratio(float log_ratio, uint depth, bool is_delta, float log_forward,
                                   float log_back) {
    if (depth == 0u) {
        // A light path cannot be connected to the camera at a delta event.
        return is_delta ? -INFINITY : log_ratio - log_forward;
    }
    return log_ratio + log_back;
}

/// Returns log2 of Q beyond the vertex at which a light path is scattered, after `depth` vertices
/// before it. `log_forward` and `log_back` are those of continue_camera_ratio. At the first vertex,
/// x_{k-1}, `log_ratio` is log2 of 1 / (p_o p_d), or -INFINITY if the light cannot be hit, and
/// `log_explicit` is log2 of p_o,explicit / (p_o E).
DEVICE float continue_light_ratio(float log_ratio, float log_explicit, uint depth, bool is_delta,
                                  float log_forward, float log_back, float beta) {
    if (depth == 0u) {
        // A delta event cannot be connected to a light.
        return log_sum(beta * (log_ratio + log_back),
                       is_delta ? -INFINITY : beta * (log_explicit - log_forward));
    }
    return log_ratio + beta * log_back;
}

/// Returns the weight of a light path that is connected to the camera at x_1. `log_back` is log2 of
/// p_wp(x_1 -> x_2), `log_first` is log2 of P_1 / n_L. `log_ratio` and `log_explicit` are those of
/// continue_light_ratio.
DEVICE float light_path_weight(float log_ratio, float log_explicit, uint depth, float log_back,
                               float log_first, float beta) {
    const float others = depth == 0u ? power_of(log_ratio + log_back + log_first, beta) +
                                           power_of(log_explicit + log_first, beta)
                                     : power_of_two(log_ratio + beta * (log_back + log_first));
    return 1.0f / (1.0f + others);
}

/// Returns log2 of (2^(beta x) + 2^(beta y))^(1 / beta).
DEVICE float log_norm(float x, float y, float beta) {
    return log_sum(beta * x, beta * y) / beta;
}

/// Returns log2 of 1 / E at a hit. `pdf_w` is the density per solid angle of the ray's direction,
/// `cosine` that at the hit, `squared` the squared length of the ray. Returns -INFINITY after a
/// delta event. Also returns -INFINITY for a hit in the plane of the surface, which does not exist
/// in exact arithmetic.
DEVICE float log_inverse_pdf_a(float pdf_w, float cosine, float squared) {
    return pdf_w < INFINITY && cosine > 0.0f ? log2_quotient(squared, cosine * pdf_w) : -INFINITY;
}

/// Returns log2 of S_i, given those of S_{i-1} and A_i. The densities are those of
/// continue_camera_ratio.
DEVICE float continue_strategies(float log_strategies, float log_arrival, bool is_delta,
                                 float log_forward, float log_back, float beta) {
    return log_norm(log_strategies + log_back, is_delta ? -INFINITY : log_arrival - log_forward,
                    beta);
}

/// Returns log2 of (A^beta + p^beta S^beta)^(1 / beta): the strategies on this side of a connected
/// vertex. `log_pdf` is log2 of p, the density per projected solid angle of the direction back
/// along the path.
DEVICE float strategies_before(float log_strategies, float log_arrival, float log_pdf, float beta) {
    return log_norm(log_arrival, log_pdf + log_strategies, beta);
}

/// Returns the weight of a connection of two vertices, given log2 of the contribution of either
/// side to p_others / p_own.
DEVICE float join_weight(float log_camera_side, float log_light_side, float beta) {
    return 1.0f / (1.0f + power_of(log_camera_side, beta) + power_of(log_light_side, beta));
}
