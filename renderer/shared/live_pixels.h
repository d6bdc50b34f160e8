// SPDX-License-Identifier: MIT
// The list of live pixels, which convergence control has not stopped, as parameters of the stages.
// Without convergence control there is no list, and all pixels are live.
#pragma once

#include "compat.h"
#include "declare.h"

/// Number of pixels that one work-item counts and lists.
#define LIVE_BLOCK 64u
#define LIVE_BLOCKS(pixels) (((pixels) + LIVE_BLOCK - 1u) / LIVE_BLOCK)

// Stage parameters and the matching arguments. Each expansion ends in a comma.
#define LIVE_LIST_PARAMETER GLOBAL const uint *live_pixels, uint live_count,
#define LIVE_PIXELS_PARAMETERS WHEN(FEATURE_convergence)(LIVE_LIST_PARAMETER)
#define LIVE_LIST_ARGUMENT live_pixels, live_count,
#define LIVE_PIXELS_ARGUMENTS WHEN(FEATURE_convergence)(LIVE_LIST_ARGUMENT)
#define HALF_FILM_PARAMETER GLOBAL long *half_film,
#define HALF_FILM_PARAMETERS WHEN(FEATURE_convergence)(HALF_FILM_PARAMETER)
#define HALF_FILM_ARGUMENT half_film,
#define HALF_FILM_ARGUMENTS WHEN(FEATURE_convergence)(HALF_FILM_ARGUMENT)

/// LIVE_COUNT is the number of live pixels among `pixels`, LIVE_PIXEL the pixel at an index of the
/// list.
#ifdef __OPENCL_VERSION__
#if FEATURE_convergence
#define LIVE_COUNT(pixels) live_count
#define LIVE_PIXEL(place) live_pixels[place]
#else
#define LIVE_COUNT(pixels) (pixels)
#define LIVE_PIXEL(place) (place)
#endif
#endif
