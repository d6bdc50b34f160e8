// SPDX-License-Identifier: MIT
// The two-wide bounding volume hierarchy in the layout that traversal reads.
//
// A node stores the boxes of its two children, so that one 64-byte fetch decides both (Aila and
// Laine 2009). A link is either the index of an inner node or a leaf, which is a run of triangles
// in leaf order. Node 0 is the root and always exists. Over fewer than five triangles, its left
// link is a leaf and its right link an empty leaf.
#pragma once

#include "renderer/shared/compat.h"

/// Marks a link as a leaf. Bits 28 to 30 hold its number of triangles, bits 0 to 27 the first of
/// them.
#define BVH_LEAF_BIT 0x80000000u
#define BVH_COUNT_SHIFT 28u
#define BVH_FIRST_MASK 0x0fffffffu
#define BVH_EMPTY_LEAF BVH_LEAF_BIT

/// Leaf threshold T of the thesis (section 3.1): a node with at most this many triangles is a leaf.
#define BVH_LEAF_SIZE 4u

/// Depth limits of the binned builder. It splits by area at depths below BVH_AREA_DEPTH, and into
/// halves by count from there on. A node at that depth has at most BVH_MAX_TRIANGLES = 2^26
/// triangles, and 24 halvings reduce them to four. Therefore no leaf is deeper than
/// BVH_BINNED_DEPTH = 38 + 24.
#define BVH_AREA_DEPTH 38u
#define BVH_BINNED_DEPTH 62u
#define BVH_MAX_TRIANGLES (1u << 26)

/// Maximum depth of a leaf in any tree. The clustering builder has no such bound by construction;
/// it gives up when a tree is deeper (hploc.h).
#define BVH_MAX_DEPTH 94u

/// Size of the traversal stack. Traversal postpones at most one child per level above the current
/// node. It thus stores at most BVH_MAX_DEPTH entries and cannot overflow the stack.
#define BVH_STACK_SIZE (BVH_MAX_DEPTH + 2u)

/// A node of the two-wide hierarchy.
typedef struct BvhNode {
    /// [left, right][lower, upper][x, y, z], in scene units; lower > upper marks an empty box.
    float bounds[2][2][3];
    uint child[2];  ///< links to the left and right child
    uint count[2];  ///< number of triangles below each child
} BvhNode;

/// Returns the link of a leaf. bvh_leaf_first and bvh_leaf_count return its parts.
DEVICE uint bvh_leaf(uint first, uint count) {
    return BVH_LEAF_BIT | (count << BVH_COUNT_SHIFT) | first;
}
DEVICE uint bvh_leaf_first(uint link) {
    return link & BVH_FIRST_MASK;
}
DEVICE uint bvh_leaf_count(uint link) {
    return (link >> BVH_COUNT_SHIFT) & 7u;
}

#ifdef __cplusplus
static_assert(sizeof(BvhNode) == 64, "one cache line");
static_assert(offsetof(BvhNode, child) == 48, "as in OpenCL C");
#endif
