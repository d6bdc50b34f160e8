// SPDX-License-Identifier: MIT
// The two-wide hierarchy in depth-first order, as traversal without a stack reads it (thesis 3.1; B. Smits, "Efficiency
// Issues for Ray Tracing", JGT 3(2), 1998): whatever is done with a node, the next one is known.
#pragma once

#include "renderer/shared/bvh_node.h"

typedef struct StacklessNode {
    float bounds[2][3];  ///< [lower, upper][x, y, z], scene units; those of node 0 are the scene's
    uint escape;         ///< the node after all below this one; the number of nodes: the end
    uint leaf;           ///< its triangles as a link (bvh_node.h); of an inner node, whose left child comes next, 0
} StacklessNode;

#ifdef __cplusplus
static_assert(sizeof(StacklessNode) == 32, "half a cache line");
#endif
