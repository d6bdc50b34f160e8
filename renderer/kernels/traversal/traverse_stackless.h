// SPDX-License-Identifier: MIT
// Traversal of the two-wide hierarchy without a stack (thesis, section 3.1).
//
// From each node, traversal continues with the nearer of its children or, if the ray misses the
// node's box, after its subtree. Departures from the thesis: boxes beyond the nearest hit so far
// count as missed, and the order of children depends on the octant of the ray's direction.
#pragma once

#include "renderer/kernels/traversal/intersect_box.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/stackless_node.h"

/// Traverses the hierarchy for both queries. `any` is a constant at every call and ends traversal
/// at the first hit.
DEVICE Hit traverse_stackless(GLOBAL const StacklessNode *nodes,
                              GLOBAL const LeafTriangle *triangles, float3 origin, float3 direction,
                              float t_max, bool any, OpacityTest opacity) {
    Hit hit = no_hit(t_max);
    TraversalRay ray;
    if (!make_traversal_ray(origin, direction, vload3(0, nodes->bounds[0]),
                            vload3(0, nodes->bounds[1]), &ray)) {
        return hit;
    }
    const uint octant = ray.entry_side[0] | ray.entry_side[1] << 1 | ray.entry_side[2] << 2;
    uint index = nodes->link + (nodes->right_first >> octant & 1u);
    while (index != 0) {
        GLOBAL const StacklessNode *node = nodes + index;
        COUNT(hit, nodes, 1u);
        if (intersect_box(node->bounds, &ray, hit.t) == INFINITY) {
            index = node->escape[octant];
        } else if ((node->link & BVH_LEAF_BIT) == 0) {
            index = node->link + (node->right_first >> octant & 1u);
        } else {
            index = node->escape[octant];
            intersect_leaf(triangles, node->link, &ray, &opacity, &hit);
            if (any && hit.slot != NO_HIT) {
                return hit;
            }
        }
    }
    if (hit.slot != NO_HIT) {
        hit.triangle = triangles[hit.slot].id;
    }
    return hit;
}
