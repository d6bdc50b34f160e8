// SPDX-License-Identifier: MIT
// The small phase: each work-item finishes one subtree of up to a few thousand primitives.
//
// It works depth first, without barriers, atomics or local memory. On a CPU the primitives stay in
// the core's cache. Nodes are written to scratch memory at the subtree's own range, since n
// primitives have at most n - 1 inner nodes. They are in depth-first order, with links relative to
// the subtree's first node.
#include "renderer/kernels/bvh/binned_sah.h"

/// A range that is still to be split.
typedef struct PendingRange {
    uint begin, end;
    uint depth;
    uint parent;  ///< node within the subtree; BVH_NO_PARENT for its root
    uint side;
    RangeBounds bounds;
} PendingRange;

/// Partitions a range stably. The left part stays in `primitives`, the right part passes through
/// `scratch`.
static void partition_range(GLOBAL PrimitiveRef *primitives, GLOBAL PrimitiveRef *scratch,
                            PRIVATE const PendingRange *range, PRIVATE const Split *split,
                            PRIVATE const Binning *binning, PRIVATE RangeBounds *left_bounds,
                            PRIVATE RangeBounds *right_bounds) {
    SignedBounds left_grown = empty_signed_bounds();
    SignedBounds right_grown = empty_signed_bounds();
    const uint begin = range->begin;
    uint left = begin;
    uint right = begin;
    for (uint i = begin; i < range->end; ++i) {
        const PrimitiveRef ref = primitives[i];
        if (goes_left(split, binning, &ref, i - begin)) {
            primitives[left] = ref;
            ++left;
            extend_bounds(&left_grown, &ref);
        } else {
            scratch[right] = ref;
            ++right;
            extend_bounds(&right_grown, &ref);
        }
    }
    for (uint i = begin; i < right; ++i) {
        primitives[left + (i - begin)] = scratch[i];
    }
    *left_bounds = range_bounds(&left_grown);
    *right_bounds = range_bounds(&right_grown);
}

static Split split_range(GLOBAL const PrimitiveRef *primitives, PRIVATE const PendingRange *range,
                         PRIVATE const Binning *binning) {
    BinSet bins;
    clear_bins(&bins);
    for (uint i = range->begin; i < range->end; ++i) {
        const PrimitiveRef ref = primitives[i];
        add_to_bins(&bins, binning, &ref);
    }
    return choose_split(&bins, binning, range->end - range->begin, range->depth,
                        inverse_extent(&range->bounds));
}

/// Orders the subtree's primitives in place, and writes its nodes and counts. The cost is the area
/// of every inner node below the subtree's root, plus the area of every leaf times its number of
/// triangles. It does not include the root.
__kernel void build_subtrees(GLOBAL BuildSubtree *subtrees, uint subtree_count,
                             GLOBAL PrimitiveRef *primitives_0, GLOBAL PrimitiveRef *primitives_1,
                             GLOBAL const BuildState *state, GLOBAL BvhNode *scratch_nodes) {
    const uint index = (uint)get_global_id(0);
    if (index >= subtree_count) {
        return;
    }
    GLOBAL BuildSubtree *subtree = subtrees + index;
    GLOBAL PrimitiveRef *primitives = subtree->buffer == 0 ? primitives_0 : primitives_1;
    GLOBAL PrimitiveRef *scratch = subtree->buffer == 0 ? primitives_1 : primitives_0;
    GLOBAL BvhNode *nodes = scratch_nodes + subtree->begin;
    const float area_scale = state->inverse_extent;

    // The right siblings of the nodes on the current path wait here; they are never more than the
    // depth of a leaf.
    PendingRange pending[BVH_BINNED_DEPTH];
    uint pending_count = 0;
    uint node_count = 0;
    uint leaf_count = 0;
    uint deepest = subtree->depth;
    float cost = 0.0f;

    PendingRange range;
    range.begin = subtree->begin;
    range.end = subtree->end;
    range.depth = subtree->depth;
    range.parent = BVH_NO_PARENT;
    range.side = 0;
    range.bounds = subtree->bounds;
    // A leaf; its parent among the top nodes links it.
    if (range.end - range.begin <= BVH_LEAF_SIZE) {
        subtree->node_count = 0;
        subtree->leaf_count = range.end > range.begin ? 1u : 0u;
        subtree->deepest_leaf = deepest;
        subtree->cost = 0.0f;
        return;
    }
    for (;;) {
        const Binning binning = make_binning(&range.bounds);
        const Split split = split_range(primitives, &range, &binning);
        PendingRange left = range;
        PendingRange right = range;
        partition_range(primitives, scratch, &range, &split, &binning, &left.bounds, &right.bounds);
        const uint node = node_count;
        ++node_count;
        if (range.parent != BVH_NO_PARENT) {
            nodes[range.parent].child[range.side] = node;
        }
        const uint middle = range.begin + split.left_count;
        left.end = middle;
        left.side = 0;
        right.begin = middle;
        right.side = 1;
        left.depth = right.depth = range.depth + 1u;
        left.parent = right.parent = node;
        deepest = max(deepest, left.depth);

        const uint left_count = left.end - left.begin;
        const uint right_count = right.end - right.begin;
        const bool left_is_leaf = left_count <= BVH_LEAF_SIZE;
        const bool right_is_leaf = right_count <= BVH_LEAF_SIZE;
        write_child(nodes + node, 0, &left.bounds, left_count,
                    bvh_leaf(left.begin, left_is_leaf ? left_count : 0u));
        write_child(nodes + node, 1, &right.bounds, right_count,
                    bvh_leaf(right.begin, right_is_leaf ? right_count : 0u));
        leaf_count += (left_is_leaf ? 1u : 0u) + (right_is_leaf ? 1u : 0u);
        cost +=
            half_area_of(&left.bounds, area_scale) * (left_is_leaf ? (float)left_count : 1.0f) +
            half_area_of(&right.bounds, area_scale) * (right_is_leaf ? (float)right_count : 1.0f);
        if (!left_is_leaf) {
            if (!right_is_leaf) {
                pending[pending_count] = right;
                ++pending_count;
            }
            range = left;
        } else if (!right_is_leaf) {
            range = right;
        } else if (pending_count > 0) {
            --pending_count;
            range = pending[pending_count];
        } else {
            break;
        }
    }
    subtree->node_count = node_count;
    subtree->leaf_count = leaf_count;
    subtree->deepest_leaf = deepest;
    subtree->cost = cost;
}
