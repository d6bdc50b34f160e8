// SPDX-License-Identifier: MIT
// The ray queries of a hierarchy in any layout (shared/bvh_layout.h).
#pragma once

#include "renderer/kernels/traversal/traverse_bvh2.h"
#include "renderer/kernels/traversal/traverse_stackless.h"
#include "renderer/kernels/traversal/traverse_wide.h"
#include "renderer/shared/bvh_layout.h"

// trace_nearest returns the nearest hit at 0 < t < t_max, where t_max may be INFINITY, that stops
// the ray. Rays that are not finite hit nothing. trace_any returns whether anything stops the ray
// at 0 < t < t_max. It is true exactly if `trace_nearest` finds a hit.
#define BVH_QUERIES(NODE, TRIANGLES, traverse)                                                     \
    DEVICE Hit trace_nearest(GLOBAL const NODE *nodes, GLOBAL const TRIANGLES *triangles,          \
                             float3 origin, float3 direction, float t_max, OpacityTest opacity) {  \
        return traverse(nodes, triangles, origin, direction, t_max, false, opacity);               \
    }                                                                                              \
    DEVICE bool trace_any(GLOBAL const NODE *nodes, GLOBAL const TRIANGLES *triangles,             \
                          float3 origin, float3 direction, float t_max, OpacityTest opacity) {     \
        return traverse(nodes, triangles, origin, direction, t_max, true, opacity).slot != NO_HIT; \
    }

#ifdef __cplusplus
BVH_QUERIES(BvhNode, LeafTriangle, traverse_bvh2)
BVH_QUERIES(StacklessNode, LeafTriangle, traverse_stackless)
BVH_QUERIES(WideNode, TriangleBlock, traverse_wide)
#else
BVH_QUERIES(BVH_NODE, BVH_TRIANGLES, TRAVERSE_BVH)
#endif
