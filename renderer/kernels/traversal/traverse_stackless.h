// SPDX-License-Identifier: MIT
// Traversal of the two-wide hierarchy without a stack (thesis 3.1): nodes in depth-first order, from each of which the way
// goes on to the next one or, where the ray misses its box, past all below it. Departure from the thesis: boxes beyond the
// nearest hit so far count as missed. The order is that of the nodes, whatever the ray's direction.
#pragma once

#include "renderer/kernels/traversal/intersect_box.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/stackless_node.h"

/// Common to both queries; `any` is a constant at every call and ends traversal at the first hit.
DEVICE Hit traverse_stackless(GLOBAL const StacklessNode *nodes, GLOBAL const LeafTriangle *triangles,
                              float3 origin, float3 direction, float t_max, bool any) {
    Hit hit = no_hit(t_max);
    TraversalRay ray;
    if (!make_traversal_ray(origin, direction, vload3(0, nodes->bounds[0]), vload3(0, nodes->bounds[1]),
                            &ray)) {
        return hit;
    }
    const uint end = nodes->escape;
    for (uint index = 1; index < end;) {
        GLOBAL const StacklessNode *node = nodes + index;
        COUNT(hit, nodes, 1u);
        if (intersect_box(node->bounds, &ray, hit.t) == INFINITY) {
            index = node->escape;
            continue;
        }
        ++index;
        if (node->leaf != 0u) {
            intersect_leaf(triangles, node->leaf, &ray, &hit);
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
