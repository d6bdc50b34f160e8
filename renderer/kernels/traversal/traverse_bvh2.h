// SPDX-License-Identifier: MIT
// Traversal of the two-wide hierarchy with a stack.
//
// Source: T. Aila, S. Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009;
// thesis, section 3.1. Both children of a node are tested. The nearer is entered. The farther is
// postponed with its distance of entry, so that a hit found in between discards it unseen.
#pragma once

#include "renderer/kernels/traversal/intersect_box.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/bvh_node.h"
#include "renderer/shared/triangle.h"

/// Traverses the hierarchy for both queries. `any` is a constant at every call and ends traversal
/// at the first hit.
DEVICE Hit traverse_bvh2(GLOBAL const BvhNode *nodes, GLOBAL const LeafTriangle *triangles,
                         float3 origin, float3 direction, float t_max, bool any,
                         OpacityTest opacity) {
    Hit hit = no_hit(t_max);
    const float3 scene_lower = make_float3(min(nodes->bounds[0][0][0], nodes->bounds[1][0][0]),
                                           min(nodes->bounds[0][0][1], nodes->bounds[1][0][1]),
                                           min(nodes->bounds[0][0][2], nodes->bounds[1][0][2]));
    const float3 scene_upper = make_float3(max(nodes->bounds[0][1][0], nodes->bounds[1][1][0]),
                                           max(nodes->bounds[0][1][1], nodes->bounds[1][1][1]),
                                           max(nodes->bounds[0][1][2], nodes->bounds[1][1][2]));
    TraversalRay ray;
    if (!make_traversal_ray(origin, direction, scene_lower, scene_upper, &ray)) {
        return hit;
    }
    uint links[BVH_STACK_SIZE];
    float entries[BVH_STACK_SIZE];
    uint size = 0;
    uint link = 0;
    for (;;) {
        if ((link & BVH_LEAF_BIT) == 0) {
            GLOBAL const BvhNode *node = nodes + link;
            COUNT(hit, nodes, 1u);
            const float left = intersect_box(node->bounds[0], &ray, hit.t);
            const float right = intersect_box(node->bounds[1], &ray, hit.t);
            const uint nearer = right < left ? 1u : 0u;
            const float near_entry = nearer ? right : left;
            const float far_entry = nearer ? left : right;
            if (near_entry < INFINITY) {
                link = node->child[nearer];
                if (far_entry < INFINITY) {
                    links[size] = node->child[1u - nearer];
                    entries[size] = far_entry;
                    ++size;
                }
                continue;
            }
        } else {
            intersect_leaf(triangles, link, &ray, &opacity, &hit);
            if (any && hit.slot != NO_HIT) {
                return hit;
            }
        }
        do {
            if (size == 0) {
                if (hit.slot != NO_HIT) {
                    hit.triangle = triangles[hit.slot].id;
                }
                return hit;
            }
            --size;
            link = links[size];
        } while (entries[size] > hit.t);
    }
}
