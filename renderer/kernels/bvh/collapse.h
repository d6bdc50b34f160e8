// SPDX-License-Identifier: MIT
// Records of the collapse to eight-wide nodes, shared by its kernels and the host that schedules
// them (renderer/bvh/collapse.cpp).
#pragma once

#include "renderer/shared/wide_node.h"

/// A wide node to be made of a node of the two-wide tree. Tasks are numbered as their nodes.
typedef struct WideTask {
    uint node;                     ///< of the two-wide tree
    uint begin;                    ///< its first triangle, in leaf order
    uint child_count;              ///< set by open_wide_nodes
    uint child_begin[WIDE_LANES];  ///< first triangle of each child
} WideTask;

/// The triangles of a leaf, a range in leaf order.
typedef struct WideLeaf {
    uint begin, count;
} WideLeaf;

/// What the host reads back.
typedef struct CollapseState {
    uint node_count;  ///< of all levels so far, the coming one included
    uint leaf_count;
} CollapseState;

#ifdef __cplusplus
static_assert(sizeof(WideTask) == 44 && sizeof(WideLeaf) == 8 && sizeof(CollapseState) == 8,
              "as in OpenCL C");
#endif
