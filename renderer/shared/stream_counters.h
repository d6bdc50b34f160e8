// SPDX-License-Identifier: MIT
// Counters of the streams between the stages. They live on the device; the host reads them only to
// learn that all work is done.
#pragma once

#include "compat.h"

/// Room for queue entries per path slot.
#define STREAM_QUEUES 3u

typedef struct StreamCounters {
    uint active[2];  ///< paths in the two active queues; queue `parity` is being worked on
    uint parity;
    uint shadow;         ///< shadow rays queued
    uint free_slots;     ///< slots whose path has ended
    uint next_work;      ///< next sample of the batch to start
    uint overflow;       ///< pushes beyond a queue's capacity: an error
    uint non_finite;     ///< samples that were NaN or infinite: not added, an error
    uint out_of_range;   ///< samples beyond the film's range: not added, an error
    uint iterations;     ///< rounds of the pipeline that had work
    ulong nearest_rays;  ///< closest-hit rays traced
    ulong shadow_rays;   ///< any-hit rays traced
} StreamCounters;

#ifndef __OPENCL_VERSION__
static_assert(sizeof(StreamCounters) == 56, "layout shared with the device");
#endif

/// What a stage is given of a stream: the words of its paths (path_state.h), its queues
/// (kernels/stream.h), its counters.
#define STREAM_PARAMETERS \
    GLOBAL uint *path_words, GLOBAL uint *queues, GLOBAL StreamCounters *counters, uint capacity
