// SPDX-License-Identifier: MIT
// Traversal of the eight-wide hierarchy.
//
// A work-item tests the eight boxes of a node, or the eight triangles of a leaf, by vector
// operations. The children that are hit are pushed onto the stack in order, with the nearest on
// top.
#pragma once

#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/wide_node.h"

#define REAL float8
#define MASK int8
#define OF_LANES(name) name##_8
#include "renderer/kernels/traversal/watertight.h"
#undef REAL
#undef MASK
#undef OF_LANES

/// Sets the distances at which the ray enters the children's boxes, and returns the bits of the
/// boxes that it meets within [0, t_max]. Conservative and safe with NaN, like the test of one box
/// (intersect_box.h).
DEVICE uint intersect_wide_boxes(GLOBAL const WideNode *node, PRIVATE const TraversalRay *ray,
                                 float t_max, PRIVATE float8 *entries) {
    float8 entry = splat_float8(0.0f);
    float8 exit = splat_float8(t_max);
    for (uint axis = 0; axis < 3; ++axis) {
        const uint side = ray->entry_side[axis];
        const float8 in =
            (vload8(0, node->bounds[side][axis]) - ray->entry_origin[axis]) * ray->inverse[axis];
        const float8 out = (vload8(0, node->bounds[1u - side][axis]) - ray->exit_origin[axis]) *
                           ray->inverse[axis];
        entry = in > entry ? in : entry;
        exit = out < exit ? out : exit;
    }
    *entries = entry;
    return lane_bits(entry <= exit * 1.00000048f);  // 1 + 2 gamma(3), Ize 2013
}

/// Updates `hit` with the nearest hit in a block at 0 < t < hit->t, if there is one.
DEVICE void intersect_block(GLOBAL const TriangleBlock *blocks, uint block,
                            PRIVATE const TraversalRay *ray, PRIVATE const OpacityTest *opacity,
                            PRIVATE Hit *hit) {
    GLOBAL const float(*xs)[WIDE_LANES] = blocks[block].coordinate[ray->kx];
    GLOBAL const float(*ys)[WIDE_LANES] = blocks[block].coordinate[ray->ky];
    GLOBAL const float(*zs)[WIDE_LANES] = blocks[block].coordinate[ray->kz];
    const EdgeFunctions_8 edges = edge_functions_8(
        ray, vload8(0, xs[0]), vload8(0, ys[0]), vload8(0, zs[0]), vload8(0, xs[1]),
        vload8(0, ys[1]), vload8(0, zs[1]), vload8(0, xs[2]), vload8(0, ys[2]), vload8(0, zs[2]));
    const int8 passed = line_meets_8(&edges);
    if (lane_bits(passed) == 0u) {
        return;
    }
    float8 t, u, v;
    uint lanes = lane_bits(passed & meets_within_8(&edges, ray, hit->t, &t, &u, &v));
    if (lanes == 0u) {
        return;
    }
    float ts[WIDE_LANES], us[WIDE_LANES], vs[WIDE_LANES];
    vstore8(t, 0, ts);
    vstore8(u, 0, us);
    vstore8(v, 0, vs);
    for (; lanes != 0u; lanes &= lanes - 1u) {
        const uint lane = lowest_bit(lanes);
        if (ts[lane] < hit->t &&
            triangle_stops(opacity, blocks[block].id[lane], us[lane], vs[lane])) {
            hit->t = ts[lane];
            hit->u = us[lane];
            hit->v = vs[lane];
            hit->slot = block * WIDE_LANES + lane;
        }
    }
}

/// Prefetches a node or a block that is pushed onto the stack. In large scenes it is in no nearby
/// cache.
DEVICE void prefetch_link(GLOBAL const WideNode *nodes, GLOBAL const TriangleBlock *blocks,
                          uint link) {
    GLOBAL const char *bytes = (link & BVH_LEAF_BIT) == 0
                                   ? (GLOBAL const char *)(nodes + link)
                                   : (GLOBAL const char *)(blocks + wide_leaf_block(link));
    // Covers a node, and most of a block.
    for (uint i = 0; i < sizeof(WideNode); i += CACHE_LINE) {
        PREFETCH(bytes + i);
    }
}

/// Traverses the hierarchy for both queries. `any` is a constant at every call and ends traversal
/// at the first hit.
DEVICE Hit traverse_wide(GLOBAL const WideNode *nodes, GLOBAL const TriangleBlock *blocks,
                         float3 origin, float3 direction, float t_max, bool any,
                         OpacityTest opacity) {
    Hit hit = no_hit(t_max);
    TraversalRay ray;
    if (!make_traversal_ray(
            origin, direction,
            make_float3(nodes->bounds[0][0][0], nodes->bounds[0][1][0], nodes->bounds[0][2][0]),
            make_float3(nodes->bounds[1][0][0], nodes->bounds[1][1][0], nodes->bounds[1][2][0]),
            &ray)) {
        return hit;
    }
    uint links[WIDE_STACK_SIZE];
    float entries[WIDE_STACK_SIZE];
    uint size = 0;
    uint link = nodes->child[0];
    for (;;) {
        if ((link & BVH_LEAF_BIT) == 0) {
            GLOBAL const WideNode *node = nodes + link;
            COUNT(hit, nodes, 1u);
            float8 entry;
            uint lanes = intersect_wide_boxes(node, &ray, hit.t, &entry);
            if (lanes != 0u) {
                link = node->child[lowest_bit(lanes)];
                const uint others = lanes & (lanes - 1u);
                if (others == 0u) {
                    continue;
                }
                float distances[WIDE_LANES];
                vstore8(entry, 0, distances);
                // Insertion sort: the nearest child ends on top and is popped at once.
                const uint bottom = size;
                for (; lanes != 0u; lanes &= lanes - 1u) {
                    const uint lane = lowest_bit(lanes);
                    const float distance = distances[lane];
                    prefetch_link(nodes, blocks, node->child[lane]);
                    uint place = size;
                    while (!any && place > bottom && entries[place - 1u] < distance) {
                        entries[place] = entries[place - 1u];
                        links[place] = links[place - 1u];
                        --place;
                    }
                    entries[place] = distance;
                    links[place] = node->child[lane];
                    ++size;
                }
                --size;
                link = links[size];
                continue;
            }
        } else {
            COUNT(hit, triangles, wide_leaf_count(link));
            intersect_block(blocks, wide_leaf_block(link), &ray, &opacity, &hit);
            if (any && hit.slot != NO_HIT) {
                return hit;
            }
        }
        do {
            if (size == 0) {
                if (hit.slot != NO_HIT) {
                    hit.triangle = blocks[hit.slot / WIDE_LANES].id[hit.slot % WIDE_LANES];
                }
                return hit;
            }
            --size;
            link = links[size];
        } while (entries[size] > hit.t);
    }
}
