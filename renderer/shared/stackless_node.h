// SPDX-License-Identifier: MIT
// The two-wide hierarchy as traversal without a stack reads it (thesis 3.1; B. Smits, "Efficiency Issues for Ray Tracing",
// JGT 3(2), 1998): whatever is done with a node, the next one is known. Departure: it is known for each octant of directions,
// so that of two children the nearer comes first. Nodes lie in depth-first order, a left child behind its parent.
#pragma once

#include "renderer/shared/bvh_node.h"

typedef struct StacklessNode {
    float bounds[2][3];  ///< [lower, upper][x, y, z], scene units; those of node 0 are the scene's
    uint link;           ///< a leaf's triangles (bvh_node.h), else the right child; the number of nodes: there is none
    uint right_first;    ///< bit o: in octant o the right child comes first
    uint escape[8];      ///< by octant, the node after all below this one; the number of nodes: the end
} StacklessNode;

#ifdef __cplusplus
static_assert(sizeof(StacklessNode) == 64, "one cache line");
#endif
