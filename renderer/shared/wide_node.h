// SPDX-License-Identifier: MIT
// The eight-wide hierarchy as traversal reads it: boxes and triangles in eights, lane by lane, for
// devices whose work-items compute on vectors (I. Wald, C. Benthin, S. Boulos, "Getting Rid of
// Packets", RT 2008).
//
// Node 0 is not part of the tree: its lane 0 holds the scene's box and the link to the root.
#pragma once

#include "renderer/shared/bvh_node.h"

#define WIDE_LANES 8u

/// A link is the index of a node or, with BVH_LEAF_BIT, a block of triangles: bits 28 to 30 hold
/// its number of triangles less one, bits 0 to 27 its index.
typedef struct WideNode {
    float bounds[2][3][WIDE_LANES];  ///< [lower, upper][x, y, z][child], scene units; lower >
                                     ///< upper: no child
    uint child[WIDE_LANES];
} WideNode;

/// Up to eight triangles; lanes beyond them repeat the first, which is found before its copies.
typedef struct TriangleBlock {
    float coordinate[3][3][WIDE_LANES];  ///< [x, y, z][vertex 0, 1, 2][triangle], scene units
    uint id[WIDE_LANES];                 ///< indices in the scene's list of triangles
} TriangleBlock;

/// Every level of the two-wide tree postpones up to seven children.
#define WIDE_STACK_SIZE (BVH_MAX_DEPTH * (WIDE_LANES - 1u) + WIDE_LANES)

DEVICE uint wide_leaf(uint block, uint count) {
    return BVH_LEAF_BIT | ((count - 1u) << BVH_COUNT_SHIFT) | block;
}
DEVICE uint wide_leaf_block(uint link) {
    return link & BVH_FIRST_MASK;
}
DEVICE uint wide_leaf_count(uint link) {
    return ((link >> BVH_COUNT_SHIFT) & 7u) + 1u;
}

#ifdef __cplusplus
static_assert(sizeof(WideNode) == 224 && sizeof(TriangleBlock) == 320, "as in OpenCL C");
#endif
