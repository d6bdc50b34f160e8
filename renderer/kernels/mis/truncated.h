// SPDX-License-Identifier: MIT
// MIS weights of truncated bidirectional path tracing (thesis (2.70)-(2.79)).
//
// MIS (n) is equation (n) of docs/mis-weights.md. The exponent beta and the log2 of densities are
// explained in power_heuristic.h.
//
// A path x_0 ... x_k, with x_0 on the lens and x_k on a light, is sampled by three strategies:
//
//   implicit    p_I    the camera path hits the light
//   explicit    p_E    the camera path is connected to a point sampled on the light
//   light       p_L    the light path is connected to a point sampled on the lens
//
// Symbols and their measures:
//
//   n_L         number of light paths for one camera sample of every pixel
//   P_1         density per area of x_1, for one camera sample of every pixel       MIS (6)
//   f_i         density per projected solid angle of scattering at x_i towards x_{i+1}
//   b_i         density per projected solid angle of scattering at x_i towards x_{i-1}
//   p_o         density per area with which a light path starts at x_k
//   p_d         density per projected solid angle of the ray that leaves x_k
//   p_oe        density per area with which light sampling samples x_k
//   E           density per area with which the ray from x_k arrives at x_{k-1}: p_d times the
//               geometry term of the two
//
// Lights at infinity have other measures: docs/mis-weights.md, "Special cases".
//
// A camera path carries the scalar R, which compares p_L and p_I:
//
//   R_0 = n_L / P_1,  R_1 = R_0 / f_1,  R_i = R_{i-1} b_i / f_i for i >= 2          MIS (11)
//   p_L / p_I = R_{k-1} p_o p_d                                                     MIS (10)
//   p_L / p_E = R_{k-2} b_{k-1} E p_o / p_oe, without b_{k-1} for k = 2             MIS (12)
//
// A light path meets the same vertices in reverse order. It carries the scalar Q. For k >= 3,
// (p_I / p_L)^beta + (p_E / p_L)^beta is (f_1 P_1 / n_L)^beta Q_2, MIS (14). At its first hit it
// carries A_{k-1} besides:
//
//   S_k = 1 / (p_o p_d),  A_{k-1} = p_oe / (p_o E)                                  MIS (20)
//   Q_{k-1} = (S_k f_{k-1} / b_{k-1})^beta + (A_{k-1} / b_{k-1})^beta               MIS (15)
//   Q_i = Q_{i+1} (f_i / b_i)^beta                                                  MIS (15)
//   1 / w_L = 1 + (f_1 P_1 / n_L)^beta Q_2 for k >= 3                               MIS (16)
//   1 / w_L = 1 + (S_2 f_1 P_1 / n_L)^beta + (A_1 P_1 / n_L)^beta for k = 2         MIS (16)
//
// For k = 1, an emitter seen directly, p_L / p_I = R_0 p_o and p_E = 0, MIS (17). Camera paths show
// emitters without noise except at their edges. Light paths also find the edges, but add noise
// inside. With integrator.seen_emitters=camera only camera paths show them, with weight 1.
#pragma once

#include "renderer/kernels/mis/power_heuristic.h"

/// Returns the weight w_I of an implicit or w_E of an explicit path. `other_over_own` is p_E / p_I
/// for w_I and p_I / p_E for w_E. `log_light_over_own` is log2 of p_L over its own density.
DEVICE float camera_path_weight(float other_over_own, float log_light_over_own, float beta) {
    // MIS (13)
    return 1.0f /
           (1.0f + heuristic_power(other_over_own, beta) + power_of(log_light_over_own, beta));
}

/// Returns log2 of R_i, given that of R_{i-1}, with i = `depth` + 1. `log_f` is log2 of f_i, which
/// is read if `depth` is 0. `log_b_over_f` is log2 of b_i / f_i.
DEVICE float continue_camera_ratio(float log_r, uint depth, bool is_delta, float log_f,
                                   float log_b_over_f) {
    if (depth == 0u) {
        // R_1 of MIS (11). A light path cannot be connected to the camera at a delta event.
        return is_delta ? -INFINITY : log_r - log_f;
    }
    return log_r + log_b_over_f;  // R_i of MIS (11)
}

/// Returns log2 of Q_i, where x_i is the vertex at which a light path is scattered after `depth`
/// events. `log_q` is log2 of Q_{i+1}, or of S_k at the first event, where i = k - 1. At that event
/// `log_a` is log2 of A_{k-1} and `log_b` is log2 of b_{k-1}. `log_f_over_b` is log2 of f_i / b_i.
DEVICE float continue_light_ratio(float log_q, float log_a, uint depth, bool is_delta, float log_b,
                                  float log_f_over_b, float beta) {
    if (depth == 0u) {
        // Q_{k-1} of MIS (15). A delta event cannot be connected to a light.
        return log_sum(beta * (log_q + log_f_over_b),
                       is_delta ? -INFINITY : beta * (log_a - log_b));
    }
    return log_q + beta * log_f_over_b;  // Q_i of MIS (15)
}

/// Returns the weight w_L of a light path that is connected to the camera at x_1, after `depth`
/// events. `log_q` is log2 of Q_2, or of S_k if `depth` is 0. `log_a` is log2 of A_1 and is read if
/// `depth` is 0. `log_f` is log2 of f_1, `log_p1_over_nl` is log2 of P_1 / n_L.
DEVICE float light_path_weight(float log_q, float log_a, uint depth, float log_f,
                               float log_p1_over_nl, float beta) {
    // MIS (16): k = 2, then k >= 3.
    const float others = depth == 0u ? power_of(log_q + log_f + log_p1_over_nl, beta) +
                                           power_of(log_a + log_p1_over_nl, beta)
                                     : power_of_two(log_q + beta * (log_f + log_p1_over_nl));
    return 1.0f / (1.0f + others);
}
