// SPDX-License-Identifier: MIT
// Counters of the streams between the stages.
//
// They are on the device. The host reads them only to learn whether all work is done.
#pragma once

#include "compat.h"

/// Numbers of queue entries per path slot in passes from the camera and from lights
/// (kernels/stream.h).
#define CAMERA_QUEUES 3u
#define LIGHT_QUEUES 4u

/// Counters of one stream.
typedef struct StreamCounters {
    uint active[2];  ///< paths in the two active queues; queue `parity` is processed in this round
    uint parity;
    uint shadow;         ///< shadow rays in the queue
    uint free_slots;     ///< slots whose path has ended
    uint next_work;      ///< next item of the batch's work to start
    uint overflow;       ///< pushes beyond the capacity of a queue: an error
    uint non_finite;     ///< samples that are NaN or infinite: not added, an error
    uint out_of_range;   ///< samples beyond the range of the film: not added, an error
    uint iterations;     ///< rounds of the pipeline that had work
    ulong nearest_rays;  ///< closest-hit rays traced
    ulong shadow_rays;   ///< any-hit rays traced
} StreamCounters;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(StreamCounters) == 56, "layout shared with the device");
#endif

/// Stream parameters of a stage: the words of its paths (path_state.h), its queues
/// (kernels/stream.h) and its counters.
#define STREAM_PARAMETERS \
    GLOBAL uint *path_words, GLOBAL uint *queues, GLOBAL StreamCounters *counters, uint capacity
