// SPDX-License-Identifier: MIT
// MIS weights of full bidirectional path tracing (Veach 1997, section 10.2).
//
// Besides the strategies of truncated.h, strategy m connects vertex x_m of the camera path to
// vertex x_{m+1} of the light path, for m = 1 ... k - 2. A path from either end carries two scalars
// for the strategies in which its last vertices are on the path from the other end. They are dVCM
// and dVC of Georgiev 2012, "Implementing vertex connection and merging".
//
// Symbols and their measures, besides those of truncated.h:
//
//   G_i         geometry term of x_i and x_{i+1}: both geometric cosines over the squared distance
//   E_i         density per area with which the path has arrived at x_i, given the vertex before
//   A_i         the strategy that connects both ends of the last ray instead of tracing it
//   S_i         all strategies in which x_i is on the path from the other end
//
// A camera path carries A and S from the lens:
//
//   A_1 = n_L / P_1,  A_i = 1 / E_i, but 0 if x_{i-1} had a delta event             MIS (19)
//   S_0 = 0,  S_i^beta = (A_i^beta + b_i^beta S_{i-1}^beta) / f_i^beta              MIS (19)
//
// A light path carries A and S from the light. The recursion is mirrored, f and b change places:
//
//   A_{k-1} = p_oe / (p_o E),  A_i = 1 / E_i, but 0 if x_{i+1} had a delta event    MIS (20)
//   S_k = 1 / (p_o p_d),  S_i^beta = (A_i^beta + f_i^beta S_{i+1}^beta) / b_i^beta  MIS (20)
//
// S_k is 0 if the light cannot be hit. S_i has no A_i at a delta event. One set of functions
// computes both: `forward` is the density in the direction of travel, f_i of a camera path and b_i
// of a light path. `reverse` is the other one. A connection of x_m and x_{m+1} has the weight
//
//   1 / w_m = 1 + (b_{m+1} G_m)^beta (A_m^beta + b_m^beta S_{m-1}^beta)
//               + (f_m G_m)^beta (A_{m+1}^beta + f_{m+1}^beta S_{m+2}^beta)         MIS (21)
//
// with A and S of the camera path in the first bracket and of the light path in the second.
//
// With R in place of S, and A at the first hits only, these are the weights of truncated.h. At most
// N vertices of a light path are stored. All strategies that connect them exist for paths of at
// most N + 1 scattering events (all_strategies of shared/integrator_settings.h). Longer paths have
// the strategies and weights of truncated.h, so that none is lost.
#pragma once

#include "renderer/kernels/mis/power_heuristic.h"

/// Returns log2 of (2^(beta x) + 2^(beta y))^(1 / beta).
DEVICE float log_norm(float x, float y, float beta) {
    return log_sum(beta * x, beta * y) / beta;
}

/// Returns log2 of 1 / E_i at a hit, where E_i = pdf_w cosine / squared. `pdf_w` is the density per
/// solid angle of the ray's direction, `cosine` that at the hit, `squared` the squared length of
/// the ray. A factor of `squared` is a factor of the result. Returns -INFINITY after a delta event.
/// Also returns -INFINITY for a hit in the plane of the surface, which does not exist in exact
/// arithmetic.
DEVICE float log_inverse_pdf_a(float pdf_w, float cosine, float squared) {
    // A_i of MIS (19) and (20)
    return pdf_w < INFINITY && cosine > 0.0f ? log2_quotient(squared, cosine * pdf_w) : -INFINITY;
}

/// Returns log2 of S at the vertex x_i at which a path is scattered. `log_s` is log2 of S at the
/// previous vertex, `log_a` is log2 of A_i. `log_forward` is log2 of the forward density,
/// `log_reverse_ratio` is log2 of the reverse over the forward density.
DEVICE float continue_strategies(float log_s, float log_a, bool is_delta, float log_forward,
                                 float log_reverse_ratio, float beta) {
    // S_i of MIS (19) and (20). A vertex with a delta event cannot be connected.
    return log_norm(log_s + log_reverse_ratio, is_delta ? -INFINITY : log_a - log_forward, beta);
}

/// Returns log2 of the bracket of a vertex x_i that is connected, to the power 1 / beta. `log_s` is
/// log2 of S at the previous vertex, `log_a` is log2 of A_i, `log_reverse` is log2 of the reverse
/// density.
DEVICE float strategies_before(float log_s, float log_a, float log_reverse, float beta) {
    return log_norm(log_a, log_reverse + log_s, beta);  // a bracket of MIS (21)
}

/// Returns the weight w_m of a connection of x_m and x_{m+1}. `log_camera_term` is log2 of
/// b_{m+1} G_m, plus `strategies_before` of the camera path at x_m. `log_light_term` is log2 of
/// f_m G_m, plus `strategies_before` of the light path at x_{m+1}.
DEVICE float connection_weight(float log_camera_term, float log_light_term, float beta) {
    // MIS (21)
    return 1.0f / (1.0f + power_of(log_camera_term, beta) + power_of(log_light_term, beta));
}
