// SPDX-License-Identifier: MIT
// The numbers of an integrator, passed to its stages by value.
#pragma once

#include "compat.h"

// Bits of IntegratorSettings::strategies. Code for a strategy is compiled in when its feature is
// on, and runs when its bit is set, so that a program with everything compiled in behaves as the
// settings say.
#define STRATEGY_IMPLICIT 1u
#define STRATEGY_EXPLICIT 2u
#define STRATEGY_LIGHT 4u
#define STRATEGY_LIGHT_EMITTERS \
    8u  // with STRATEGY_LIGHT: light paths show emitters, too, that the camera sees directly
#define STRATEGY_HITS_ELSEWHERE 16u  // what paths hit is weighed, but added by another pass

#define TERMINATION_FIXED 0u
#define TERMINATION_ROULETTE 1u
#define TERMINATION_ADAPTIVE 2u

#define SAMPLER_INDEPENDENT 0u
#define SAMPLER_SOBOL 1u
#define SAMPLER_REGULAR 2u

#define UNLIMITED_DEPTH 0xffffffffu

typedef struct IntegratorSettings {
    uint seed;
    uint strategies;           ///< STRATEGY_* bits
    uint termination;          ///< TERMINATION_*
    uint max_depth;            ///< scattering events, UNLIMITED_DEPTH for none
    float beta;                ///< exponent of the power heuristic
    float max_continuation;    ///< largest probability that roulette lets a path go on, below 1
    float adaptive_threshold;  ///< adaptive termination: paths end below this throughput
    uint light_paths;          ///< per sample of the image
    uint light_vertices;       ///< kept of each light path where they are joined to camera paths
    uint sampler;              ///< SAMPLER_*
} IntegratorSettings;

/// Whether paths of so many scattering events are found by all strategies of full bidirectional
/// path tracing, where light vertices are kept: joined to the camera's first, the last of them
/// makes paths of one event more.
DEVICE bool all_strategies(IntegratorSettings settings, uint events) {
    return events <= settings.light_vertices + 1u;
}

#ifndef __OPENCL_VERSION__
static_assert(sizeof(IntegratorSettings) == 40, "layout shared with the device");
#endif
