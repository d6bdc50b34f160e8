// SPDX-License-Identifier: MIT
// Trials: numbers of light paths that a pilot compares (session/pilot.h).
//
// A path knows the ratios of the densities of all its strategies. Another number of light paths
// changes only the factor n_L in them (docs/mis-weights.md). Each path therefore finds what it
// would have contributed in every trial.
#pragma once

#include "compat.h"

#define LIGHT_PATH_TRIALS 8u

/// Returns log2 of the number of light paths in a trial over the number of those traced: 1/64,
/// 1/16, ... 64. Trial 0 has no light paths and no such factor.
DEVICE float trial_log_factor(uint trial) {
    return 2.0f * (float)trial - 8.0f;
}

/// What a path found.
typedef struct PathTrials {
    /// By trial: luminance of a camera path, root of the sum of the squared luminances of a light
    /// path's contributions.
    float value[LIGHT_PATH_TRIALS];
    /// Light paths under a guide: light and bin of the start (shared/emission_guide.h), as light *
    /// GUIDE_BINS + row * GUIDE_COLUMNS + column, with bin 0 for a light without a table.
    uint start;
    /// Light paths under a guide: the probability with which the light was selected, times g.
    float start_density;
} PathTrials;
