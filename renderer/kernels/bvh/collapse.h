// SPDX-License-Identifier: MIT
// Records of the collapse to eight-wide nodes, shared by its kernels and the host that schedules
// them (renderer/bvh/collapse.cpp).
#pragma once

#include "renderer/shared/wide_node.h"

/// A wide node to be made from a node of the two-wide tree. The index of a task is that of its wide
/// node.
typedef struct WideTask {
    uint node;                     ///< node of the two-wide tree
    uint begin;                    ///< first of its triangles, in leaf order
    uint child_count;              ///< set by open_wide_nodes
    uint child_begin[WIDE_LANES];  ///< first triangle of each child
} WideTask;

/// The triangles of a leaf, a range in leaf order.
typedef struct WideLeaf {
    uint begin, count;
} WideLeaf;

/// Results that the host reads back.
typedef struct CollapseState {
    uint node_count;  ///< number of nodes in all levels so far, including the next
    uint leaf_count;
} CollapseState;

#ifdef __cplusplus
static_assert(sizeof(WideTask) == 44 && sizeof(WideLeaf) == 8 && sizeof(CollapseState) == 8,
              "as in OpenCL C");
#endif
