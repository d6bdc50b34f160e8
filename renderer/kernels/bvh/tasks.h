// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/kernels/bvh/build_records.h"

/// Books the range [begin, end), child `side` of top node `parent`, as the next level's task or, when it is
/// small enough for one work-item, as a subtree. Called by single work-items in a fixed order: numbering is
/// deterministic. Returns the index of the task's node, or BVH_EMPTY_LEAF for a subtree (place_subtrees links
/// it).
DEVICE uint emit_range(PRIVATE BuildState *state, GLOBAL BuildTask *tasks, GLOBAL BuildChunk *chunks,
                       GLOBAL BuildSubtree *subtrees, uint chunk_size, uint subtree_size, uint begin,
                       uint end, uint depth, uint parent, uint side, uint buffer,
                       PRIVATE const RangeBounds *bounds) {
    if (end - begin <= subtree_size) {
        GLOBAL BuildSubtree *subtree = subtrees + state->subtree_count;
        state->subtree_count += 1u;
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
    GLOBAL BuildTask *task = tasks + state->task_count;
    task->begin = begin;
    task->end = end;
    task->depth = depth;
    task->node = state->top_node_count;
    task->first_chunk = state->chunk_count;
    task->chunk_count = (end - begin + chunk_size - 1u) / chunk_size;
    task->bounds = *bounds;
    for (uint i = 0; i < task->chunk_count; ++i) {
        GLOBAL BuildChunk *chunk = chunks + state->chunk_count + i;
        chunk->task = state->task_count;
        chunk->begin = begin + i * chunk_size;
        chunk->end = min(begin + (i + 1u) * chunk_size, end);
    }
    state->chunk_count += task->chunk_count;
    state->task_count += 1u;
    state->top_node_count += 1u;
    return task->node;
}
