// SPDX-License-Identifier: MIT
// The two-wide bounding volume hierarchy as traversal reads it.
//
// A node holds the boxes of its two children, so that one 64-byte fetch decides both (Aila and
// Laine 2009). Its links are either the index of an inner node or a leaf: a run of triangles in
// leaf order. Node 0 is the root and always exists: over fewer than five triangles its left link is
// a leaf and its right one an empty leaf.
#pragma once

#include "renderer/shared/compat.h"

/// The link is a leaf: bits 28 to 30 hold its number of triangles, bits 0 to 27 the first of them.
#define BVH_LEAF_BIT 0x80000000u
#define BVH_COUNT_SHIFT 28u
#define BVH_FIRST_MASK 0x0fffffffu
#define BVH_EMPTY_LEAF BVH_LEAF_BIT

/// Leaf threshold T of the thesis (3.1): a node of at most this many triangles is a leaf.
#define BVH_LEAF_SIZE 4u

/// The builder splits by area as long as a node is less deep than this, and in halves by count from
/// here on. A node at this depth holds at most BVH_MAX_TRIANGLES = 2^26 triangles, and 24 halvings
/// bring those to four: no leaf of it is deeper than BVH_BINNED_DEPTH = 38 + 24.
#define BVH_AREA_DEPTH 38u
#define BVH_BINNED_DEPTH 62u
#define BVH_MAX_TRIANGLES (1u << 26)

/// No leaf of any tree is deeper. Clustering has no bound of its own and gives up beyond (hploc.h).
#define BVH_MAX_DEPTH 94u

/// Traversal keeps at most one postponed child for each level above the current node, hence never
/// more than BVH_MAX_DEPTH entries: its stack cannot overflow.
#define BVH_STACK_SIZE (BVH_MAX_DEPTH + 2u)

typedef struct BvhNode {
    float bounds[2][2]
                [3];  ///< [left, right][lower, upper][x, y, z], scene units; lower > upper: empty
    uint child[2];    ///< links of left and right
    uint count[2];    ///< triangles below them
} BvhNode;

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
