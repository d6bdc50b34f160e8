// SPDX-License-Identifier: MIT
// Queues of path slots between the stages. One buffer holds all queues, with `capacity` entries
// each. Their lengths are in StreamCounters.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/stream_counters.h"

// Indices of the queues in the buffer. Queues 0 and 1 are the active queues, used alternately. The
// free queue and the shadow queue share an index because their lifetimes do not overlap: the free
// queue is in use from extend_path to generate_camera_rays, the shadow queue from sample_light to
// intersect_any.
#define QUEUE_FREE 2u
#define QUEUE_SHADOW 2u

/// Number of queue entries that one work-item processes, one after the other. It is 1 on a GPU and
/// larger on a CPU, where one atomic operation then appends the results of all entries.
#ifndef STREAM_CHUNK
#define STREAM_CHUNK 1
#endif

/// Loops over the entries of this work-item in a queue of `count` entries.
#define FOR_EACH_ENTRY(i, count)                              \
    for (uint i = (uint)get_global_id(0) * STREAM_CHUNK,      \
              i##_end = min(i + STREAM_CHUNK, (uint)(count)); \
         i < i##_end; ++i)

/// Slots that a work-item is about to append to a queue.
typedef struct PushBuffer {
    uint slots[STREAM_CHUNK];
    uint count;
} PushBuffer;

DEVICE void push_slot(PRIVATE PushBuffer *buffer, uint slot) {
    buffer->slots[buffer->count++] = slot;
}

/// Appends slots to a queue. An overflow overwrites nothing; it is counted and ends the run with an
/// error. All appends go through this function.
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

/// Work for the free slots of this work-item. The `count` slots from entry `slots` of the free
/// queue on receive the items from `first` on, except items beyond the batch's work.
typedef struct WorkItems {
    uint slots;
    uint first;
    uint count;
} WorkItems;

/// Takes work items for the free slots of this work-item. An item is a path of the batch. A batch
/// has at most 2^31 items, and a round overshoots them by at most `capacity`. The counter therefore
/// does not wrap before the host sees the end.
DEVICE WorkItems take_work(GLOBAL StreamCounters *counters) {
    WorkItems items;
    items.slots = min((uint)get_global_id(0) * STREAM_CHUNK, counters->free_slots);
    items.count = min(items.slots + STREAM_CHUNK, counters->free_slots) - items.slots;
    items.first = items.count > 0u ? atomic_add(&counters->next_work, items.count) : 0u;
    return items;
}

/// Returns the number of paths processed in this round.
DEVICE uint active_count(GLOBAL const StreamCounters *counters) {
    return counters->active[counters->parity];
}

/// Returns the queue of the paths processed in this round.
DEVICE GLOBAL const uint *active_queue(GLOBAL const uint *queues,
                                       GLOBAL const StreamCounters *counters, uint capacity) {
    return queues + counters->parity * capacity;
}

/// Appends paths to active queue `parity`.
DEVICE void append_active(GLOBAL uint *queues, GLOBAL StreamCounters *counters, uint capacity,
                          uint parity, PRIVATE const PushBuffer *buffer) {
    append_slots(queues, parity, capacity, &counters->active[parity], counters, buffer);
}
