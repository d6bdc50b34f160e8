// SPDX-License-Identifier: MIT
// The eight-wide hierarchy in the layout that traversal reads.
//
// Boxes and triangles are stored in groups of eight, lane by lane, for devices whose work-items
// compute on vectors (I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", RT 2008). Node 0 is
// not part of the tree: its lane 0 holds the scene's box and the link to the root.
#pragma once

#include "renderer/shared/bvh_node.h"

#define WIDE_LANES 8u

/// A node with up to eight children. A link is the index of a node or, with BVH_LEAF_BIT, a block
/// of triangles. Bits 28 to 30 of a leaf hold its number of triangles minus one, bits 0 to 27 the
/// index of the block.
typedef struct WideNode {
    /// [lower, upper][x, y, z][child], in scene units; lower > upper marks a missing child.
    float bounds[2][3][WIDE_LANES];
    uint child[WIDE_LANES];
} WideNode;

/// A block of up to eight triangles. Unused lanes repeat the first triangle, which is found before
/// its copies.
typedef struct TriangleBlock {
    float coordinate[3][3][WIDE_LANES];  ///< [x, y, z][vertex 0, 1, 2][triangle], in scene units
    uint id[WIDE_LANES];                 ///< indices in the scene's list of triangles
} TriangleBlock;

/// Size of the traversal stack. Every level of the two-wide tree postpones up to seven children.
#define WIDE_STACK_SIZE (BVH_MAX_DEPTH * (WIDE_LANES - 1u) + WIDE_LANES)

/// Returns the link of a leaf. wide_leaf_block and wide_leaf_count return its parts.
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
