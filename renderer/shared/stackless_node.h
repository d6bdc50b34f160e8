// SPDX-License-Identifier: MIT
// The two-wide hierarchy as traversal without a stack reads it (thesis 3.1; B. Smits, "Efficiency
// Issues for Ray Tracing", JGT 3(2), 1998): whatever is done with a node, the next one is known.
// Departures: it is known for each octant of directions, so that of two children the nearer comes
// first; and both children of a node lie side by side, from an even index on, so that a processor
// that fetches cache lines by pairs has the second where it has the first. Pairs lie in depth-first
// order of their parents. Node 0 is the scene, node 1 is never read, its children are the nodes 2
// and 3.
#pragma once

#include "renderer/shared/bvh_node.h"

typedef struct StacklessNode {
    float bounds[2][3];  ///< [lower, upper][x, y, z], scene units; lower > upper: empty
    uint link;  ///< a leaf's triangles (bvh_node.h), else the left child; the right one lies behind
                ///< it
    uint right_first;  ///< bit o: in octant o the right child comes first
    uint escape[8];    ///< by octant, the node after all below this one; 0: the end
} StacklessNode;

/// The node of [left, right] child `side` of the node of the two-wide tree that is at `place` in
/// depth-first order.
DEVICE uint stackless_child(uint place, uint side) {
    return 2u * place + 2u + side;
}

#ifdef __cplusplus
static_assert(sizeof(StacklessNode) == 64, "one cache line");
#endif
