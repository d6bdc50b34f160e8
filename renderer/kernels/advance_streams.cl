// SPDX-License-Identifier: MIT
// Stages that maintain the counters of the streams. They do not depend on path states, so one
// program serves all scenes.

#include "renderer/kernels/stream.h"

/// Puts slot i into the free queue.
DEVICE void free_slot(Stream stream, uint i) {
    queue_entries(stream, QUEUE_FREE)[i] = i;
}

/// Sets the counters of a stream whose slots are all free. Ray counts and error counts are kept.
DEVICE void reset_counters(GLOBAL StreamCounters *counters, uint capacity, uint first_work) {
    counters->active[0] = 0u;
    counters->active[1] = 0u;
    counters->parity = 0u;
    counters->shadow = 0u;
    counters->free_slots = capacity;
    counters->next_work = first_work;
}

/// Stage reset_streams: frees all slots and starts work at item `first_work`.
///
/// STAGE(reset_streams,
///       writes(counters),
///       to(free))
__kernel void reset_streams(uint first_work, STREAM_PARAMETERS) {
    const Stream stream = STREAM_VIEW;
    const uint i = get_global_id(0);
    if (i < capacity) {
        free_slot(stream, i);
    }
    if (i == 0u) {
        reset_counters(counters, capacity, first_work);
    }
}

/// Stage begin_round (one work-item): marks the free slots as handed out and counts the nearest-hit
/// rays of the round.
///
/// STAGE(begin_round,
///       writes(counters))
__kernel void begin_round(GLOBAL StreamCounters *counters) {
    if (get_global_id(0) == 0u) {
        const uint active = counters->active[counters->parity];
        counters->free_slots = 0u;
        counters->nearest_rays += active;
        counters->iterations += active > 0u ? 1u : 0u;
    }
}

/// Stage end_shadow_rays (one work-item): counts the traced shadow rays and empties their queue.
///
/// STAGE(end_shadow_rays,
///       writes(counters))
__kernel void end_shadow_rays(GLOBAL StreamCounters *counters) {
    if (get_global_id(0) == 0u) {
        counters->shadow_rays += counters->shadow;
        counters->shadow = 0u;
    }
}

/// Stage end_round (one work-item): swaps the active queues. The round has filled the other one.
///
/// STAGE(end_round,
///       writes(counters))
__kernel void end_round(GLOBAL StreamCounters *counters) {
    if (get_global_id(0) == 0u) {
        counters->active[counters->parity] = 0u;
        counters->parity = 1u - counters->parity;
    }
}
