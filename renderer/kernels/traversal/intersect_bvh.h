// SPDX-License-Identifier: MIT
// The queries of a hierarchy, whatever its layout (shared/bvh_layout.h).
#pragma once

// What layouts share comes first: the include resolver expands a file where it is named first,
// compiled or not.
#include "renderer/kernels/traversal/intersect_box.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/bvh_layout.h"

#if defined(__cplusplus) || BVH_LAYOUT == BVH_LAYOUT_BVH2
#include "renderer/kernels/traversal/traverse_bvh2.h"
#endif
#if defined(__cplusplus) || BVH_LAYOUT == BVH_LAYOUT_STACKLESS
#include "renderer/kernels/traversal/traverse_stackless.h"
#endif
#if defined(__cplusplus) || BVH_LAYOUT == BVH_LAYOUT_WIDE8
#include "renderer/kernels/traversal/traverse_wide.h"
#endif

// trace_nearest: the nearest hit at 0 < t < t_max (which may be INFINITY). Rays that are not finite
// hit nothing. trace_any: whether anything is hit at 0 < t < t_max: true exactly when
// `trace_nearest` finds a hit.
#define BVH_QUERIES(NODE, TRIANGLES, traverse)                                            \
    DEVICE Hit trace_nearest(GLOBAL const NODE *nodes, GLOBAL const TRIANGLES *triangles, \
                             float3 origin, float3 direction, float t_max) {              \
        return traverse(nodes, triangles, origin, direction, t_max, false);               \
    }                                                                                     \
    DEVICE bool trace_any(GLOBAL const NODE *nodes, GLOBAL const TRIANGLES *triangles,    \
                          float3 origin, float3 direction, float t_max) {                 \
        return traverse(nodes, triangles, origin, direction, t_max, true).slot != NO_HIT; \
    }

#ifdef __cplusplus
BVH_QUERIES(BvhNode, LeafTriangle, traverse_bvh2)
BVH_QUERIES(StacklessNode, LeafTriangle, traverse_stackless)
BVH_QUERIES(WideNode, TriangleBlock, traverse_wide)
#else
BVH_QUERIES(BVH_NODE, BVH_TRIANGLES, TRAVERSE_BVH)
#endif
