// SPDX-License-Identifier: MIT
// The two-wide hierarchy in the layout that stackless traversal reads.
//
// Source: thesis, section 3.1; B. Smits, "Efficiency Issues for Ray Tracing", JGT 3(2), 1998.
// Whatever the result at a node, the next node is known. Departures:
// - The next node is known for each octant of directions, so that the nearer of two children comes
//   first.
// - Both children of a node are adjacent, from an even index on. A processor that fetches cache
//   lines in pairs thus has the second child together with the first.
//
// Pairs are in depth-first order of their parents. Node 0 is the scene, and its children are nodes
// 2 and 3. Node 1 is never read.
#pragma once

#include "renderer/shared/bvh_node.h"

/// A node of the two-wide hierarchy for stackless traversal.
typedef struct StacklessNode {
    /// [lower, upper][x, y, z], in scene units; lower > upper marks an empty box.
    float bounds[2][3];
    /// The triangles of a leaf (bvh_node.h) or the index of the left child; the right child follows
    /// it.
    uint link;
    uint right_first;  ///< bit o is set if the right child comes first in octant o
    uint escape[8];    ///< by octant: the node after this subtree; 0 at the end
} StacklessNode;

/// Returns the index of child `side` (0 left, 1 right) of a node. `place` is the index of that node
/// in the depth-first order of the two-wide tree.
DEVICE uint stackless_child(uint place, uint side) {
    return 2u * place + 2u + side;
}

#ifdef __cplusplus
static_assert(sizeof(StacklessNode) == 64, "one cache line");
#endif
