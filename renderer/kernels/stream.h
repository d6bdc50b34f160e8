// SPDX-License-Identifier: MIT
// Queues of path slots between the stages. One buffer holds them all, `capacity` entries each;
// their lengths are in StreamCounters.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/stream_counters.h"

// Queue numbers within the buffer: active queues 0 and 1 take turns. The free and the shadow queue
// share their room: one lives from extend_path to generate_camera_rays, the other from sample_light
// to intersect_any.
#define QUEUE_FREE 2u
#define QUEUE_SHADOW 2u

/// Entries of a queue that one work-item takes, one after the other: 1 on a GPU, more on a CPU,
/// where what it appends then costs one atomic operation for all of them.
#ifndef STREAM_CHUNK
#define STREAM_CHUNK 1
#endif

/// The entries [begin, end) of this work-item in a queue of `count`.
#define FOR_EACH_ENTRY(i, count)                              \
    for (uint i = (uint)get_global_id(0) * STREAM_CHUNK,      \
              i##_end = min(i + STREAM_CHUNK, (uint)(count)); \
         i < i##_end; ++i)

/// Slots to append to a queue.
typedef struct PushBuffer {
    uint slots[STREAM_CHUNK];
    uint count;
} PushBuffer;

DEVICE void push_slot(PRIVATE PushBuffer *buffer, uint slot) {
    buffer->slots[buffer->count++] = slot;
}

/// The one way to append: checked. An overflow is counted and ends the run with an error; nothing
/// is overwritten.
DEVICE void append_slots(GLOBAL uint *queues, uint queue, uint capacity,
                         volatile GLOBAL uint *length, GLOBAL StreamCounters *counters,
                         PRIVATE const PushBuffer *buffer) {
    if (buffer->count == 0u) {
        return;
    }
    const uint first = atomic_add(length, buffer->count);
    for (uint i = 0; i < buffer->count; ++i) {
        if (first + i < capacity) {
            queues[queue * capacity + first + i] = buffer->slots[i];
        } else {
            atomic_inc(&counters->overflow);
        }
    }
}

/// Work for the free slots of this work-item: `count` slots from entry `slots` of the free queue
/// on, to be given items from `first` on, those beyond the batch's work excepted.
typedef struct WorkItems {
    uint slots;
    uint first;
    uint count;
} WorkItems;

/// Items of work are paths of the batch. There are at most 2^31 and
/// a round overshoots them by at most `capacity`, so the counter does not wrap before the host sees
/// the end.
DEVICE WorkItems take_work(GLOBAL StreamCounters *counters) {
    WorkItems items;
    items.slots = min((uint)get_global_id(0) * STREAM_CHUNK, counters->free_slots);
    items.count = min(items.slots + STREAM_CHUNK, counters->free_slots) - items.slots;
    items.first = items.count > 0u ? atomic_add(&counters->next_work, items.count) : 0u;
    return items;
}

/// Paths worked on in this round.
DEVICE uint active_count(GLOBAL const StreamCounters *counters) {
    return counters->active[counters->parity];
}

DEVICE GLOBAL const uint *active_queue(GLOBAL const uint *queues,
                                       GLOBAL const StreamCounters *counters, uint capacity) {
    return queues + counters->parity * capacity;
}

DEVICE void append_active(GLOBAL uint *queues, GLOBAL StreamCounters *counters, uint capacity,
                          uint parity, PRIVATE const PushBuffer *buffer) {
    append_slots(queues, parity, capacity, &counters->active[parity], counters, buffer);
}
