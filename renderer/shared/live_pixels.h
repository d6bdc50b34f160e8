// SPDX-License-Identifier: MIT
// The live pixels, which convergence control has not stopped, or those of a pilot. Without either
// there is no list, and all pixels are live.
#pragma once

#include "compat.h"

/// Number of pixels that one work-item counts and lists.
#define LIVE_BLOCK 64u
#define LIVE_BLOCKS(pixels) (((pixels) + LIVE_BLOCK - 1u) / LIVE_BLOCK)

#ifdef __OPENCL_VERSION__

#define LISTS_PIXELS (FEATURE_convergence || FEATURE_light_path_trials)

/// The pixels that receive camera paths.
typedef struct LivePixels {
    GLOBAL const uint *list;  ///< read only with LISTS_PIXELS
    uint count;
} LivePixels;

/// Returns the live pixels among `pixels`; `list` and `count` are those of convergence control or
/// of a pilot.
DEVICE LivePixels make_live_pixels(GLOBAL const uint *list, uint count, uint pixels) {
    const LivePixels live = {list, LISTS_PIXELS ? count : pixels};
    return live;
}

/// Returns the pixel at an index among the live pixels.
DEVICE uint live_pixel(LivePixels live, uint i) {
    return LISTS_PIXELS ? live.list[i] : i;
}

#endif
