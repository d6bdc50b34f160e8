// SPDX-License-Identifier: MIT
// One level of the large phase: every node above the subtree size, whatever its size, is split by all
// work-items together (thesis 3.1). bin_primitives (a work-item per chunk) -> choose_splits (per task) ->
// partition_primitives (per chunk, from one primitive buffer to the other) -> emit_children (one work-item).
// Departure from the thesis: offsets are prefix sums over chunks instead of atomic counters, so that the
// partition is stable and the tree the same whatever the order of execution.
#include "renderer/kernels/bvh/binned_sah.h"
#include "renderer/kernels/bvh/tasks.h"

__kernel void bin_primitives(GLOBAL const BuildTask *tasks, GLOBAL const BuildChunk *chunks, uint chunk_count,
                             GLOBAL const PrimitiveRef *primitives, GLOBAL BinSet *chunk_bins) {
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

/// Sums a task's bins, chooses its split, and counts for each of its chunks what goes left before it.
__kernel void choose_splits(GLOBAL BuildTask *tasks, uint task_count, GLOBAL BuildChunk *chunks,
                            GLOBAL const BinSet *chunk_bins) {
    const uint index = (uint)get_global_id(0);
    if (index >= task_count) {
        return;
    }
    GLOBAL BuildTask *task = tasks + index;
    const RangeBounds bounds = task->bounds;
    const Binning binning = make_binning(&bounds);
    BinSet bins;
    clear_bins(&bins);
    for (uint chunk = task->first_chunk; chunk < task->first_chunk + task->chunk_count; ++chunk) {
        for (uint place = 0; place < BVH_BINNED_AXES; ++place) {
            for (uint bin = 0; bin < BVH_BINS; ++bin) {
                vstore8(enclosing(vload8(0, bins.box[place][bin]), vload8(0, chunk_bins[chunk].box[place][bin])), 0,
                        bins.box[place][bin]);
                bins.count[place][bin] += chunk_bins[chunk].count[place][bin];
            }
        }
    }
    const Split split =
        choose_split(&bins, &binning, task->end - task->begin, task->depth, inverse_extent(&bounds));
    task->split = split;
    uint left = 0;
    for (uint chunk = task->first_chunk; chunk < task->first_chunk + task->chunk_count; ++chunk) {
        if (split.axis == BVH_SPLIT_BY_COUNT) {
            left = min(chunks[chunk].begin - task->begin, split.left_count);
        }
        chunks[chunk].left_before = left;
        if (split.axis != BVH_SPLIT_BY_COUNT) {
            for (uint bin = 0; bin <= split.last_left_bin; ++bin) {
                left += chunk_bins[chunk].count[PLACE_OF_AXIS(split.axis)][bin];
            }
        }
    }
}

__kernel void partition_primitives(GLOBAL const BuildTask *tasks, GLOBAL BuildChunk *chunks, uint chunk_count,
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
    uint next[2];
    next[0] = task_begin + chunk->left_before;
    next[1] = task_begin + split.left_count + (chunk->begin - task_begin - chunk->left_before);
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

/// One work-item: writes this level's nodes and books their children for the next level or the small phase.
/// `buffer` is the index of the buffer that partition_primitives wrote.
__kernel void emit_children(GLOBAL BuildState *state, GLOBAL const BuildTask *tasks,
                            GLOBAL const BuildChunk *chunks, uint task_count, uint chunk_size,
                            uint subtree_size, uint buffer, GLOBAL BvhNode *nodes,
                            GLOBAL BuildTask *next_tasks, GLOBAL BuildChunk *next_chunks,
                            GLOBAL BuildSubtree *subtrees) {
    if (get_global_id(0) != 0) {
        return;
    }
    BuildState next = *state;
    next.task_count = 0;
    next.chunk_count = 0;
    for (uint t = 0; t < task_count; ++t) {
        const BuildTask task = tasks[t];
        const uint middle = task.begin + task.split.left_count;
        for (uint side = 0; side < 2; ++side) {
            RangeBounds bounds = empty_bounds();
            for (uint chunk = task.first_chunk; chunk < task.first_chunk + task.chunk_count; ++chunk) {
                merge_bounds(&bounds, &chunks[chunk].bounds[side]);
            }
            const uint begin = side == 0 ? task.begin : middle;
            const uint end = side == 0 ? middle : task.end;
            const uint link = emit_range(&next, next_tasks, next_chunks, subtrees, chunk_size, subtree_size, begin, end,
                                         task.depth + 1u, task.node, side, buffer, &bounds);
            write_child(nodes + task.node, side, &bounds, end - begin, link);
        }
    }
    *state = next;
}
