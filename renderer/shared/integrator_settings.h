// SPDX-License-Identifier: MIT
// The numeric settings of an integrator, passed to its stages by value.
#pragma once

#include "compat.h"

// Bits of IntegratorSettings::strategies. The code of a strategy is compiled in if its feature is
// on, and runs if its bit is set. A program with all features compiled in therefore still follows
// the settings.
#define STRATEGY_IMPLICIT 1u
#define STRATEGY_EXPLICIT 2u
#define STRATEGY_LIGHT 4u
// With STRATEGY_LIGHT: light paths also show emitters that the camera sees directly.
#define STRATEGY_LIGHT_EMITTERS 8u
// Emission hit by paths has its MIS weight, but another pass adds it to the film.
#define STRATEGY_HITS_ELSEWHERE 16u
// The camera sees no emitter directly, whatever is in between.
#define STRATEGY_EMITTERS_OUT_OF_VIEW 32u

#define TERMINATION_FIXED 0u
#define TERMINATION_ROULETTE 1u
#define TERMINATION_ADAPTIVE 2u

#define SAMPLER_INDEPENDENT 0u
#define SAMPLER_SOBOL 1u
#define SAMPLER_REGULAR 2u

// Sobol points: sample i belongs to sequence i % SOBOL_SEQUENCES. The sequences have independent
// scramblings, so that the scatter of their means shows the error. Each further sequence would cost
// more of what stratification gains.
#define SOBOL_SEQUENCES 2u
// Number of samples after which all sequences are others.
#define SOBOL_PERIOD (SOBOL_SEQUENCES * 0x100000000ul)
// Number of events of a path, from its start on, that have Sobol points.
#define SOBOL_EVENTS 2u

#define UNLIMITED_DEPTH 0xffffffffu

/// The settings of an integrator.
typedef struct IntegratorSettings {
    uint seed;
    uint strategies;         ///< STRATEGY_* bits
    uint termination;        ///< TERMINATION_*
    uint max_depth;          ///< maximum number of scattering events; UNLIMITED_DEPTH for no limit
    float beta;              ///< exponent of the power heuristic
    float max_continuation;  ///< largest continuation probability of roulette, below 1
    float roulette_start;    ///< throughput below which roulette may end a path at a delta
    uint roulette_event;     ///< first scattering event at which roulette may end a path
    float adaptive_threshold;  ///< throughput below which adaptive termination ends a path
    uint light_paths;          ///< number of light paths per sample of the image
    /// Number of vertices stored per light path, if they are connected to camera paths.
    uint light_vertices;
    uint sampler;  ///< SAMPLER_*
    // The film as a window of the full picture, whose pixels have the random numbers.
    uint film_width;   ///< pixels
    uint full_width;   ///< pixels
    uint first_pixel;  ///< index in the full picture of the film's first pixel
    /// Number of paths before whose hits a pilot stores their trials (shared/light_path_trials.h);
    /// 0: it stores no hits.
    uint training_paths;
} IntegratorSettings;

/// Returns whether all strategies of full bidirectional path tracing exist for paths of `events`
/// scattering events, if light vertices are stored. A connection of the last stored light vertex to
/// the first hit of a camera path makes a path of `light_vertices` + 1 events.
DEVICE bool all_strategies(IntegratorSettings settings, uint events) {
    return events <= settings.light_vertices + 1u;
}

#ifndef __OPENCL_VERSION__
static_assert(sizeof(IntegratorSettings) == 64, "layout shared with the device");
#endif
