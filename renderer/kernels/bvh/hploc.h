// SPDX-License-Identifier: MIT
// Records of the clustering builder, shared by its kernels and the host that schedules them
// (renderer/bvh/hploc.cpp).
//
// Source: C. Benthin, D. Meister, J. Barczak, R. Mehalwal, J. Tsakok, A. Kensler, "H-PLOC:
// Hierarchical Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction", HPG
// 2024: primitives are sorted along a space-filling curve; every node of the radix tree over their
// codes takes what its children left, at most twice HPLOC_KEPT clusters, and unites nearest
// neighbours until it leaves HPLOC_KEPT at most to its parent. What a node makes depends on its
// range alone, so the tree is the same whoever makes it and when. Departures: a range of at most
// two nodes' clusters is not divided further; a work-item finishes the subtrees of small ranges
// alone, depth first; those above are made level by level instead of by whichever child comes last,
// which OpenCL 1.2 does not order in memory.
#pragma once

#include "renderer/kernels/bvh/build_records.h"

/// Clusters that a range leaves to the one above it, at most.
#define HPLOC_KEPT 16u

/// A cluster looks for its nearest neighbour among this many behind it in order, and as many before
/// it.
#define HPLOC_RADIUS 8u

/// Levels of the radix tree: 63 bits of the code, and halving what has the same code, at most 2^26.
#define HPLOC_LEVELS 90u

/// Nodes whose costs are summed together: fixed, so that the sum of all has the same bits
/// everywhere.
#define BVH_COST_BLOCK 1024u

/// A range of the sorted primitives above the subtree size.
typedef struct CodeRange {
    uint begin, middle, end;
} CodeRange;

/// A range that one work-item finishes.
typedef struct CodeSubtree {
    uint begin, end;
} CodeSubtree;

/// What is known of a cluster node besides its BvhNode. Nodes are numbered by place: a primitive
/// begins with the place of its own; the union of two takes that of the first, and leaves that of
/// the second to what it becomes part of.
typedef struct ClusterNode {
    uint count;   ///< of triangles; 0: no node
    uint nodes;   ///< of the finished tree, from this one down: 0 where it becomes a leaf
    uint height;  ///< edges down to the deepest leaf
    uint parent;  ///< 2 x number + side; BVH_NO_PARENT for the root
} ClusterNode;

/// What the host reads back.
typedef struct ClusterState {
    uint range_count;  ///< of all levels so far, the coming one included
    uint subtree_count;
    uint root;
    uint node_count;  ///< of the finished tree
    uint depth;
} ClusterState;

#ifdef __cplusplus
static_assert(sizeof(CodeRange) == 12 && sizeof(CodeSubtree) == 8 && sizeof(ClusterNode) == 16 &&
                  sizeof(ClusterState) == 20,
              "as in OpenCL C");
#endif
