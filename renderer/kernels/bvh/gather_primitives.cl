// SPDX-License-Identifier: MIT
// Input of the builder: which triangles can be hit, their boxes in input order, the first task.
// Three stages: check_triangles (a work-item per chunk of the input), begin_build (one work-item),
// gather_primitives (per chunk). Order is kept, so what follows does not depend on scheduling.
#include "renderer/kernels/bvh/input_triangle.h"
#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/kernels/bvh/tasks.h"

__kernel void check_triangles(GLOBAL const float *positions, uint vertex_count, GLOBAL const uint *indices,
                              uint triangle_count, uint chunk_size, GLOBAL InputChunk *chunks) {
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
        const TriangleFault fault = load_primitive(positions, vertex_count, indices, triangle, &ref);
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

/// One work-item: prefix sums over the chunks, and the root as task or subtree.
__kernel void begin_build(GLOBAL InputChunk *input, uint input_chunk_count, uint chunk_size,
                          uint subtree_size, GLOBAL BuildState *state, GLOBAL BuildTask *tasks,
                          GLOBAL BuildChunk *chunks, GLOBAL BuildSubtree *subtrees) {
    if (get_global_id(0) != 0) {
        return;
    }
    BuildState total = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.0f, 0.0f, 0.0f};
    RangeBounds bounds = empty_bounds();
    for (uint i = 0; i < input_chunk_count; ++i) {
        input[i].accepted_before = total.primitive_count;
        total.primitive_count += input[i].accepted;
        total.not_finite += input[i].not_finite;
        total.degenerate += input[i].degenerate;
        total.bad_index += input[i].bad_index;
        merge_bounds(&bounds, &input[i].bounds);
    }
    total.inverse_extent = inverse_extent(&bounds);
    total.root_area = half_area_of(&bounds, total.inverse_extent);
    emit_range(&total, tasks, chunks, subtrees, chunk_size, subtree_size, 0, total.primitive_count, 0,
               BVH_NO_PARENT, 0, 0, &bounds);
    *state = total;
}

__kernel void gather_primitives(GLOBAL const float *positions, uint vertex_count, GLOBAL const uint *indices,
                                uint triangle_count, uint chunk_size, GLOBAL const InputChunk *chunks,
                                GLOBAL PrimitiveRef *primitives) {
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
