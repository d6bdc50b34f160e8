// SPDX-License-Identifier: MIT
// The stream of a pass: the paths in flight and the queues of path slots between the stages. One
// buffer holds all queues, with `capacity` entries each. Their lengths are in StreamCounters.
#pragma once

#include "renderer/shared/compat.h"
#include "renderer/shared/stream_counters.h"

// Indices of the queues in the buffer. Queues 0 and 1 are the active queues, used alternately. The
// free queue is in use from the stage that ends paths to the one that starts paths. The shadow
// queue is in use from a stage that connects paths to the one that traces the shadow rays. They
// share memory in passes from the camera. In passes from lights one stage starts and connects
// paths.
#define QUEUE_FREE 2u
#define QUEUE_SHADOW (FEATURE_from_light ? LIGHT_QUEUES - 1u : CAMERA_QUEUES - 1u)

/// Number of queue entries that one work-item processes, one after the other. It is 1 on a GPU and
/// larger on a CPU, where one atomic operation then appends the results of all entries.
#ifndef STREAM_CHUNK
#define STREAM_CHUNK 1
#endif

/// Loops over the entries of this work-item in a queue of `count` entries. Declares i and i_end,
/// the end of these entries.
#define FOR_EACH_ENTRY(i, count)                              \
    for (uint i = (uint)get_global_id(0) * STREAM_CHUNK,      \
              i##_end = min(i + STREAM_CHUNK, (uint)(count)); \
         i < i##_end; ++i)

/// The path states, queues and counters of a pass.
typedef struct Stream {
    GLOBAL uint *path_words;
    GLOBAL uint *queues;
    GLOBAL StreamCounters *counters;
    uint capacity;
} Stream;

/// The stream of a kernel that has STREAM_PARAMETERS.
#define STREAM_VIEW \
    { path_words, queues, counters, capacity }

/// Slots that a work-item is about to append to a queue.
typedef struct PushBuffer {
    uint slots[STREAM_CHUNK];
    uint count;
} PushBuffer;

DEVICE void push_slot(PRIVATE PushBuffer *buffer, uint slot) {
    buffer->slots[buffer->count++] = slot;
}

/// Returns the entries of a queue.
DEVICE GLOBAL uint *queue_entries(Stream stream, uint queue) {
    return stream.queues + queue * stream.capacity;
}

/// Appends slots to a queue. An overflow overwrites nothing; it is counted and ends the run with an
/// error. All appends go through this function.
DEVICE void append_slots(Stream stream, uint queue, volatile GLOBAL uint *length,
                         PRIVATE const PushBuffer *buffer) {
    if (buffer->count == 0u) {
        return;
    }
    const uint first = atomic_add(length, buffer->count);
    for (uint i = 0; i < buffer->count; ++i) {
        if (first + i < stream.capacity) {
            queue_entries(stream, queue)[first + i] = buffer->slots[i];
        } else {
            atomic_inc(&stream.counters->overflow);
        }
    }
}

/// Appends started paths to the active queue of this round.
DEVICE void append_started(Stream stream, PRIVATE const PushBuffer *started) {
    const uint queue = stream.counters->parity;
    append_slots(stream, queue, &stream.counters->active[queue], started);
}

/// Appends paths that continue to the active queue of the next round.
DEVICE void append_continued(Stream stream, PRIVATE const PushBuffer *continued) {
    const uint queue = 1u - stream.counters->parity;
    append_slots(stream, queue, &stream.counters->active[queue], continued);
}

/// Appends the slots of paths that have ended to the free queue.
DEVICE void append_free(Stream stream, PRIVATE const PushBuffer *ended) {
    append_slots(stream, QUEUE_FREE, &stream.counters->free_slots, ended);
}

/// Appends paths with a shadow ray to the shadow queue.
DEVICE void append_shadow(Stream stream, PRIVATE const PushBuffer *shadow) {
    append_slots(stream, QUEUE_SHADOW, &stream.counters->shadow, shadow);
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
DEVICE WorkItems take_work(Stream stream) {
    const uint free_slots = stream.counters->free_slots;
    WorkItems items;
    items.slots = min((uint)get_global_id(0) * STREAM_CHUNK, free_slots);
    items.count = min(items.slots + STREAM_CHUNK, free_slots) - items.slots;
    items.first = items.count > 0u ? atomic_add(&stream.counters->next_work, items.count) : 0u;
    return items;
}

/// Returns the number of paths processed in this round.
DEVICE uint active_count(Stream stream) {
    return stream.counters->active[stream.counters->parity];
}

/// Returns the queue of the paths processed in this round.
DEVICE GLOBAL const uint *active_queue(Stream stream) {
    return queue_entries(stream, stream.counters->parity);
}

/// Returns the number of paths with a shadow ray.
DEVICE uint shadow_count(Stream stream) {
    return stream.counters->shadow;
}

/// Returns the queue of the paths with a shadow ray.
DEVICE GLOBAL const uint *shadow_queue(Stream stream) {
    return queue_entries(stream, QUEUE_SHADOW);
}
