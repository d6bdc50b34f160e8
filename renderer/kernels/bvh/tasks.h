// SPDX-License-Identifier: MIT
// Tasks and chunks of the binned builder: their sizes, and the registration of ranges as tasks or
// subtrees.
#pragma once

#include "renderer/kernels/bvh/build_records.h"

/// Indices of the next task, its first chunk and its node, and of the next subtree.
typedef struct Numbers {
    uint task, chunk, node, subtree;
} Numbers;

/// Returns the number of primitives in each chunk of a task of `count` primitives, except the last
/// chunk.
DEVICE uint chunk_length(uint count, uint chunk_size) {
    return max(chunk_size, (count - 1u) / BVH_CHUNKS_PER_TASK + 1u);
}

/// Returns the number of chunks of a range of `count` primitives; 0 if it is small enough for one
/// work-item.
DEVICE uint chunks_of(uint count, uint chunk_size, uint subtree_size) {
    return count <= subtree_size ? 0u : (count - 1u) / chunk_length(count, chunk_size) + 1u;
}

/// Registers the range [begin, end), child `side` of top node `parent`. It becomes a subtree if it
/// is small enough for one work-item, otherwise a task of the next level. The caller assigns
/// `numbers` in a fixed order. Returns the index of the task's node, or BVH_EMPTY_LEAF for a
/// subtree, which place_subtrees links.
DEVICE uint emit_range(PRIVATE const Numbers *numbers, GLOBAL BuildTask *tasks,
                       GLOBAL BuildChunk *chunks, GLOBAL BuildSubtree *subtrees, uint chunk_size,
                       uint subtree_size, uint begin, uint end, uint depth, uint parent, uint side,
                       uint buffer, PRIVATE const RangeBounds *bounds) {
    const uint chunk_count = chunks_of(end - begin, chunk_size, subtree_size);
    if (chunk_count == 0u) {
        GLOBAL BuildSubtree *subtree = subtrees + numbers->subtree;
        subtree->begin = begin;
        subtree->end = end;
        subtree->depth = depth;
        subtree->parent = parent;
        subtree->side = side;
        subtree->buffer = buffer;
        subtree->bounds = *bounds;
        subtree->padding = 0;
        return BVH_EMPTY_LEAF;
    }
    GLOBAL BuildTask *task = tasks + numbers->task;
    task->begin = begin;
    task->end = end;
    task->depth = depth;
    task->node = numbers->node;
    task->first_chunk = numbers->chunk;
    task->chunk_count = chunk_count;
    task->bounds = *bounds;
    const uint length = chunk_length(end - begin, chunk_size);
    for (uint i = 0; i < chunk_count; ++i) {
        GLOBAL BuildChunk *chunk = chunks + numbers->chunk + i;
        chunk->task = numbers->task;
        chunk->begin = begin + i * length;
        chunk->end = min(begin + (i + 1u) * length, end);
    }
    return numbers->node;
}
