// SPDX-License-Identifier: MIT
// Trials: settings that a pilot compares (session/pilot.h). They are eight numbers of light paths
// with explicit paths, then the same numbers without.
//
// A path knows the ratios of the densities of all its strategies. Another number of light paths
// changes only the factor n_L in them, and p_oe is 0 without explicit paths (docs/mis-weights.md).
// Each path therefore finds what it would have contributed in every trial.
#pragma once

#include "compat.h"

#define LIGHT_PATH_NUMBERS 8u
#define LIGHT_PATH_TRIALS (2u * LIGHT_PATH_NUMBERS)

/// Camera paths of a pixel in a pilot.
#define TRIAL_SAMPLES 8u

/// Returns whether light paths are traced in a trial.
DEVICE bool trial_has_light_paths(uint trial) {
    return trial % LIGHT_PATH_NUMBERS != 0u;
}

/// Returns whether camera paths are connected to light samples in a trial.
DEVICE bool trial_is_explicit(uint trial) {
    return trial < LIGHT_PATH_NUMBERS;
}

/// Returns log2 of the number of light paths in a trial over the number of those traced: 1/64,
/// 1/16, ... 64. Trials without light paths have no such factor.
DEVICE float trial_log_factor(uint trial) {
    return 2.0f * (float)(trial % LIGHT_PATH_NUMBERS) - 8.0f;
}

/// What a path found.
typedef struct PathTrials {
    /// By trial: luminance of a camera path, root of the sum of the squared luminances of a light
    /// path's contributions.
    float value[LIGHT_PATH_TRIALS];
    /// Light paths under a guide: light and bin of the start (shared/guide_layout.h), as light *
    /// GUIDE_BINS + row * GUIDE_COLUMNS + column, with bin 0 for a light without a table.
    uint start;
    /// Light paths under a guide: the probability with which the light was selected, times g.
    float start_density;
} PathTrials;

/// Number of hits of a light path that train a scatter guide. They follow the trials of all paths,
/// those of a path one after the other.
#define TRAINING_HITS 4u

/// Light that arrives at a surface where camera paths may be guided, after 1 to TRAINING_HITS
/// events: where it arrives at once, camera paths sample the light.
typedef struct TrainingHit {
    float position[3];
    float power;  ///< luminance of the path's throughput, W; 0: there is no such hit
    uint side;    ///< as in shared/guide_layout.h, of the normal on the side of the light
    uint bin;     ///< of the direction to where it comes from, as row * GUIDE_COLUMNS + column
} TrainingHit;
