// SPDX-License-Identifier: MIT
// Stages that read the input of the builder: they select the triangles that can be hit, compute
// their boxes in input order, and create the first task.
//
// check_triangles (one work-item per chunk of the input), begin_build (one work-group),
// gather_primitives (one work-item per chunk). The order of triangles is kept, so later stages do
// not depend on scheduling.
#include "renderer/kernels/bvh/input_triangle.h"
#include "renderer/kernels/bvh/one_group.h"
#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/kernels/bvh/tasks.h"

__kernel void check_triangles(GLOBAL const float *positions, uint vertex_count,
                              GLOBAL const uint *indices, uint triangle_count, uint chunk_size,
                              GLOBAL InputChunk *chunks) {
    const uint chunk = (uint)get_global_id(0);
    const uint begin = chunk * chunk_size;
    if (begin >= triangle_count) {
        return;
    }
    const uint end = min(begin + chunk_size, triangle_count);
    uint faults[4] = {0, 0, 0, 0};
    SignedBounds bounds = empty_signed_bounds();
    for (uint triangle = begin; triangle < end; ++triangle) {
        PrimitiveRef ref;
        const TriangleFault fault =
            load_primitive(positions, vertex_count, indices, triangle, &ref);
        faults[fault] += 1u;
        if (fault == TRIANGLE_GOOD) {
            extend_bounds(&bounds, &ref);
        }
    }
    chunks[chunk].bounds = range_bounds(&bounds);
    chunks[chunk].accepted = faults[TRIANGLE_GOOD];
    chunks[chunk].not_finite = faults[TRIANGLE_NOT_FINITE];
    chunks[chunk].degenerate = faults[TRIANGLE_DEGENERATE];
    chunks[chunk].bad_index = faults[TRIANGLE_BAD_INDEX];
}

/// Computes prefix sums over the chunks, and registers the root as a task or a subtree. One
/// work-group.
__kernel void begin_build(GLOBAL InputChunk *input, uint input_chunk_count, uint chunk_size,
                          uint subtree_size, GLOBAL BuildState *state, GLOBAL BuildTask *tasks,
                          GLOBAL BuildChunk *chunks, GLOBAL BuildSubtree *subtrees) {
    __local uint shared[ONE_GROUP];
    const uint item = (uint)get_local_id(0);
    BuildState total = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.0f, 0.0f, 0.0f};
    RangeBounds bounds = empty_bounds();
    uint faults[3] = {0, 0, 0};
    for (uint first = 0; first < input_chunk_count; first += ONE_GROUP) {
        const uint i = first + item;
        const bool is_chunk = i < input_chunk_count;
        uint accepted;
        const uint before = sum_before(shared, is_chunk ? input[i].accepted : 0u, &accepted);
        if (is_chunk) {
            input[i].accepted_before = total.primitive_count + before;
            faults[0] += input[i].not_finite;
            faults[1] += input[i].degenerate;
            faults[2] += input[i].bad_index;
            merge_bounds(&bounds, &input[i].bounds);
        }
        total.primitive_count += accepted;
    }
    sum_before(shared, faults[0], &total.not_finite);
    sum_before(shared, faults[1], &total.degenerate);
    sum_before(shared, faults[2], &total.bad_index);
    if (item < input_chunk_count) {
        input[item].bounds = bounds;  // bounds of this chunk and every ONE_GROUP-th after it
    }
    barrier(CLK_GLOBAL_MEM_FENCE);
    if (item != 0) {
        return;
    }
    for (uint i = 1; i < min(ONE_GROUP, input_chunk_count); ++i) {
        merge_bounds(&bounds, &input[i].bounds);
    }
    total.inverse_extent = inverse_extent(&bounds);
    total.root_area = half_area_of(&bounds, total.inverse_extent);
    total.chunk_count = chunks_of(total.primitive_count, chunk_size, subtree_size);
    total.task_count = total.chunk_count > 0u ? 1u : 0u;
    total.top_node_count = total.task_count;
    total.subtree_count = 1u - total.task_count;
    const Numbers numbers = {0, 0, 0, 0};
    emit_range(&numbers, tasks, chunks, subtrees, chunk_size, subtree_size, 0,
               total.primitive_count, 0, BVH_NO_PARENT, 0, 0, &bounds);
    *state = total;
}

__kernel void gather_primitives(GLOBAL const float *positions, uint vertex_count,
                                GLOBAL const uint *indices, uint triangle_count, uint chunk_size,
                                GLOBAL const InputChunk *chunks, GLOBAL PrimitiveRef *primitives) {
    const uint chunk = (uint)get_global_id(0);
    const uint begin = chunk * chunk_size;
    if (begin >= triangle_count) {
        return;
    }
    const uint end = min(begin + chunk_size, triangle_count);
    uint next = chunks[chunk].accepted_before;
    for (uint triangle = begin; triangle < end; ++triangle) {
        PrimitiveRef ref;
        if (load_primitive(positions, vertex_count, indices, triangle, &ref) == TRIANGLE_GOOD) {
            primitives[next] = ref;
            ++next;
        }
    }
}
