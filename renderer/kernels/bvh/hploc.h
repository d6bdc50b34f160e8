// SPDX-License-Identifier: MIT
// Records of the clustering builder, shared by its kernels and the host that schedules them
// (renderer/bvh/hploc.cpp).
//
// Source: C. Benthin, D. Meister, J. Barczak, R. Mehalwal, J. Tsakok, A. Kensler, "H-PLOC:
// Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction", HPG
// 2024. Primitives are sorted along a space-filling curve. Every node of the radix tree over their
// codes receives the clusters left by its children, at most 2 HPLOC_KEPT. The node merges nearest
// neighbours until at most HPLOC_KEPT remain for its parent. The result of a node depends on its
// range alone, so the tree does not depend on which work-item processes a node or when.
//
// Departures:
// - A range of at most two nodes' clusters is not divided further.
// - A work-item finishes the subtrees of small ranges alone, depth first.
// - The ranges above are processed level by level. In the paper, the child that finishes last
//   processes its parent; OpenCL 1.2 does not order memory accesses for that.
#pragma once

#include "renderer/kernels/bvh/build_records.h"

/// Maximum number of clusters that a range leaves to the range above it.
#define HPLOC_KEPT 16u

/// Search radius: a cluster looks for its nearest neighbour among this many clusters after it in
/// order, and as many before it.
#define HPLOC_RADIUS 8u

/// Maximum number of levels of the radix tree: 63 bits of the code, and halvings of ranges of equal
/// codes, of at most 2^26 primitives.
#define HPLOC_LEVELS 90u

/// Number of nodes whose costs are summed together. It is fixed, so that the total has the same
/// bits everywhere.
#define BVH_COST_BLOCK 1024u

/// A range of the sorted primitives above the subtree size.
typedef struct CodeRange {
    uint begin, middle, end;
} CodeRange;

/// A range that one work-item finishes.
typedef struct CodeSubtree {
    uint begin, end;
} CodeSubtree;

/// Data of a cluster node besides its BvhNode. The index of a node is a location: a primitive
/// starts with its own location. The union of two clusters uses the location of the first, and
/// passes that of the second on to the union that it becomes part of.
typedef struct ClusterNode {
    uint count;   ///< number of triangles; 0 if there is no node
    uint nodes;   ///< number of nodes of the finished tree in this subtree; 0 if it becomes a leaf
    uint height;  ///< number of edges down to the deepest leaf
    uint parent;  ///< 2 x index + side; BVH_NO_PARENT for the root
} ClusterNode;

/// Results that the host reads back.
typedef struct ClusterState {
    uint range_count;  ///< number of ranges in all levels so far, including the next
    uint subtree_count;
    uint root;
    uint node_count;  ///< number of nodes of the finished tree
    uint depth;
} ClusterState;

#ifdef __cplusplus
static_assert(sizeof(CodeRange) == 12 && sizeof(CodeSubtree) == 8 && sizeof(ClusterNode) == 16 &&
                  sizeof(ClusterState) == 20,
              "as in OpenCL C");
#endif
