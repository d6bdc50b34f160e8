// SPDX-License-Identifier: MIT
// One level of the large phase: all work-items together split every node above the subtree size
// (thesis, section 3.1).
//
// The stages of a level are:
// - bin_primitives (one work-item per chunk)
// - merge_bins (several work-items per task)
// - choose_splits (one per task)
// - partition_primitives (one per chunk), from one primitive buffer to the other
// - merge_children (one per child)
// - emit_children (one work-group)
//
// Departure from the thesis: offsets are prefix sums over chunks instead of atomic counters. The
// partition is therefore stable, and the tree does not depend on the order of execution.
#include "renderer/kernels/bvh/binned_sah.h"
#include "renderer/kernels/bvh/one_group.h"
#include "renderer/kernels/bvh/tasks.h"

/// Bins the primitives of a chunk.
__kernel void bin_primitives(GLOBAL const BuildTask *tasks, GLOBAL const BuildChunk *chunks,
                             uint chunk_count, GLOBAL const PrimitiveRef *primitives,
                             GLOBAL BinSet *chunk_bins) {
    const uint chunk = (uint)get_global_id(0);
    if (chunk >= chunk_count) {
        return;
    }
    const RangeBounds bounds = tasks[chunks[chunk].task].bounds;
    const Binning binning = make_binning(&bounds);
    BinSet bins;
    clear_bins(&bins);
    const uint end = chunks[chunk].end;
    for (uint i = chunks[chunk].begin; i < end; ++i) {
        const PrimitiveRef ref = primitives[i];
        add_to_bins(&bins, &binning, &ref);
    }
    chunk_bins[chunk] = bins;
}

/// Sums each bin over the chunks of a task, and replaces the counts of each chunk by those of the
/// chunks before it. `parts` work-items share the bins of a task.
__kernel void merge_bins(GLOBAL const BuildTask *tasks, uint task_count, uint parts,
                         GLOBAL BinSet *chunk_bins, GLOBAL BinSet *task_bins) {
    const uint index = (uint)get_global_id(0) / parts;
    const uint part = (uint)get_global_id(0) % parts;
    if (index >= task_count) {
        return;
    }
    const uint bins = BVH_BINNED_AXES * BVH_BINS;
    const uint first_chunk = tasks[index].first_chunk;
    const uint end_chunk = first_chunk + tasks[index].chunk_count;
    for (uint i = bins * part / parts; i < bins * (part + 1u) / parts; ++i) {
        const uint place = i / BVH_BINS;
        const uint bin = i % BVH_BINS;
        float8 box = splat_float8(INFINITY);
        uint count = 0;
        for (uint chunk = first_chunk; chunk < end_chunk; ++chunk) {
            box = enclosing(box, vload8(0, chunk_bins[chunk].box[place][bin]));
            const uint in_chunk = chunk_bins[chunk].count[place][bin];
            chunk_bins[chunk].count[place][bin] = count;
            count += in_chunk;
        }
        vstore8(box, 0, task_bins[index].box[place][bin]);
        task_bins[index].count[place][bin] = count;
    }
}

/// Chooses the split of a task.
__kernel void choose_splits(GLOBAL BuildTask *tasks, uint task_count,
                            GLOBAL const BinSet *task_bins) {
    const uint index = (uint)get_global_id(0);
    if (index >= task_count) {
        return;
    }
    GLOBAL BuildTask *task = tasks + index;
    const RangeBounds bounds = task->bounds;
    const Binning binning = make_binning(&bounds);
    const BinSet bins = task_bins[index];
    task->split = choose_split(&bins, &binning, task->end - task->begin, task->depth,
                               inverse_extent(&bounds));
}

/// Returns the number of primitives in the task's earlier chunks that go left.
DEVICE uint left_before(PRIVATE const Split *split, uint before, GLOBAL const BinSet *bins) {
    if (split->axis == BVH_SPLIT_BY_COUNT) {
        return min(before, split->left_count);
    }
    uint left = 0;
    for (uint bin = 0; bin <= split->last_left_bin; ++bin) {
        left += bins->count[PLACE_OF_AXIS(split->axis)][bin];
    }
    return left;
}

/// Partitions the primitives of a chunk stably, and computes the bounds of both parts.
__kernel void partition_primitives(GLOBAL const BuildTask *tasks, GLOBAL BuildChunk *chunks,
                                   uint chunk_count, GLOBAL const BinSet *chunk_bins,
                                   GLOBAL const PrimitiveRef *source, GLOBAL PrimitiveRef *target) {
    const uint index = (uint)get_global_id(0);
    if (index >= chunk_count) {
        return;
    }
    GLOBAL BuildChunk *chunk = chunks + index;
    GLOBAL const BuildTask *task = tasks + chunk->task;
    const Split split = task->split;
    const RangeBounds task_bounds = task->bounds;
    const Binning binning = make_binning(&task_bounds);
    SignedBounds bounds[2];
    bounds[0] = empty_signed_bounds();
    bounds[1] = empty_signed_bounds();
    const uint task_begin = task->begin;
    const uint before = chunk->begin - task_begin;
    const uint left = left_before(&split, before, chunk_bins + index);
    uint next[2];
    next[0] = task_begin + left;
    next[1] = task_begin + split.left_count + (before - left);
    const uint end = chunk->end;
    for (uint i = chunk->begin; i < end; ++i) {
        const PrimitiveRef ref = source[i];
        const uint side = goes_left(&split, &binning, &ref, i - task_begin) ? 0u : 1u;
        target[next[side]] = ref;
        next[side] += 1u;
        extend_bounds(&bounds[side], &ref);
    }
    chunk->bounds[0] = range_bounds(&bounds[0]);
    chunk->bounds[1] = range_bounds(&bounds[1]);
}

/// Merges the bounds of a task's child over the chunks.
__kernel void merge_children(GLOBAL BuildTask *tasks, uint task_count,
                             GLOBAL const BuildChunk *chunks) {
    const uint child = (uint)get_global_id(0);
    if (child >= 2u * task_count) {
        return;
    }
    GLOBAL BuildTask *task = tasks + child / 2u;
    const uint end_chunk = task->first_chunk + task->chunk_count;
    RangeBounds bounds = empty_bounds();
    for (uint chunk = task->first_chunk; chunk < end_chunk; ++chunk) {
        merge_bounds(&bounds, &chunks[chunk].bounds[child % 2u]);
    }
    task->children[child % 2u] = bounds;
}

/// Writes the nodes of this level, and registers their children for the next level or the small
/// phase. One work-group. `buffer` is the index of the buffer that partition_primitives wrote.
__kernel void emit_children(GLOBAL BuildState *state, GLOBAL const BuildTask *tasks,
                            uint task_count, uint chunk_size, uint subtree_size, uint buffer,
                            GLOBAL BvhNode *nodes, GLOBAL BuildTask *next_tasks,
                            GLOBAL BuildChunk *next_chunks, GLOBAL BuildSubtree *subtrees) {
    __local uint shared[ONE_GROUP];
    BuildState next = *state;
    next.task_count = 0;
    next.chunk_count = 0;
    for (uint first = 0; first < 2u * task_count; first += ONE_GROUP) {
        const uint child = first + (uint)get_local_id(0);
        const uint side = child % 2u;
        uint begin = 0, end = 0;
        if (child < 2u * task_count) {
            GLOBAL const BuildTask *task = tasks + child / 2u;
            const uint middle = task->begin + task->split.left_count;
            begin = side == 0 ? task->begin : middle;
            end = side == 0 ? middle : task->end;
        }
        const uint chunks = chunks_of(end - begin, chunk_size, subtree_size);
        uint new_tasks, new_chunks, new_subtrees;
        const uint tasks_before = sum_before(shared, chunks > 0u ? 1u : 0u, &new_tasks);
        Numbers numbers;
        numbers.task = next.task_count + tasks_before;
        numbers.node = next.top_node_count + tasks_before;
        numbers.chunk = next.chunk_count + sum_before(shared, chunks, &new_chunks);
        // Neither side of a split is empty.
        numbers.subtree = next.subtree_count +
                          sum_before(shared, chunks == 0u && end > begin ? 1u : 0u, &new_subtrees);
        if (end > begin) {
            GLOBAL const BuildTask *task = tasks + child / 2u;
            const RangeBounds bounds = task->children[side];
            const uint link =
                emit_range(&numbers, next_tasks, next_chunks, subtrees, chunk_size, subtree_size,
                           begin, end, task->depth + 1u, task->node, side, buffer, &bounds);
            write_child(nodes + task->node, side, &bounds, end - begin, link);
        }
        next.task_count += new_tasks;
        next.top_node_count += new_tasks;
        next.chunk_count += new_chunks;
        next.subtree_count += new_subtrees;
    }
    if (get_local_id(0) == 0) {
        *state = next;
    }
}
