// SPDX-License-Identifier: MIT
// Queues of path slots between the stages. One buffer holds them all, `capacity` entries each; their lengths are
// in StreamCounters.
#pragma once

#include "shared/compat.h"
#include "shared/stream_counters.h"

// Queue numbers within the buffer: active queues 0 and 1 take turns. The free and the shadow queue share their
// room: one lives from extend_path to generate_camera_rays, the other from sample_light to intersect_any.
#define QUEUE_FREE 2u
#define QUEUE_SHADOW 2u

/// The one way to append: checked. An overflow is counted and ends the run with an error; nothing is overwritten.
DEVICE void push_slot(GLOBAL uint *queues, uint queue, uint capacity, volatile GLOBAL uint *length,
                      GLOBAL StreamCounters *counters, uint slot) {
    const uint position = atomic_inc(length);
    if (position < capacity) {
        queues[queue * capacity + position] = slot;
    } else {
        atomic_inc(&counters->overflow);
    }
}

/// Paths worked on in this round.
DEVICE uint active_count(GLOBAL const StreamCounters *counters) { return counters->active[counters->parity]; }

DEVICE uint active_slot(GLOBAL const uint *queues, GLOBAL const StreamCounters *counters, uint capacity, uint i) {
    return queues[counters->parity * capacity + i];
}

DEVICE void push_active(GLOBAL uint *queues, GLOBAL StreamCounters *counters, uint capacity, uint parity, uint slot) {
    push_slot(queues, parity, capacity, &counters->active[parity], counters, slot);
}
