// SPDX-License-Identifier: MIT
// The two-wide tree in depth-first order (shared/stackless_node.h): count_subtrees (one work-item) -> write_stackless_nodes (a
// work-item per node). The builder numbers parents before their children, which makes both sums single passes.
#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/shared/stackless_node.h"

/// Nodes in depth-first order below and including child `side`.
static uint child_size(GLOBAL const BvhNode *node, uint side, GLOBAL const uint *sizes) {
    const uint link = node->child[side];
    return node->count[side] == 0 ? 0u : (link & BVH_LEAF_BIT) != 0 ? 1u : sizes[link];
}

/// One work-item: the size of every subtree, children first, then the place of every node, parents first.
__kernel void count_subtrees(GLOBAL const BvhNode *nodes, uint node_count, GLOBAL uint *sizes, GLOBAL uint *places) {
    if (get_global_id(0) != 0) {
        return;
    }
    for (uint i = node_count; i-- > 0;) {
        sizes[i] = 1u + child_size(nodes + i, 0, sizes) + child_size(nodes + i, 1, sizes);
    }
    places[0] = 0;
    for (uint i = 0; i < node_count; ++i) {
        uint place = places[i] + 1u;
        for (uint side = 0; side < 2; ++side) {
            if ((nodes[i].child[side] & BVH_LEAF_BIT) == 0) {
                places[nodes[i].child[side]] = place;
            }
            place += child_size(nodes + i, side, sizes);
        }
    }
}

/// Writes the children of a node; the root's work-item writes the root, too.
__kernel void write_stackless_nodes(GLOBAL const BvhNode *nodes, uint node_count, GLOBAL const uint *sizes,
                                    GLOBAL const uint *places, GLOBAL StacklessNode *stackless_nodes) {
    const uint index = (uint)get_global_id(0);
    if (index >= node_count) {
        return;
    }
    GLOBAL const BvhNode *node = nodes + index;
    if (index == 0) {
        for (uint axis = 0; axis < 3; ++axis) {
            stackless_nodes->bounds[0][axis] = lesser(node->bounds[0][0][axis], node->bounds[1][0][axis]);
            stackless_nodes->bounds[1][axis] = greater(node->bounds[0][1][axis], node->bounds[1][1][axis]);
        }
        stackless_nodes->escape = sizes[0];
        stackless_nodes->leaf = 0;
    }
    uint place = places[index] + 1u;
    for (uint side = 0; side < 2; ++side) {
        const uint size = child_size(node, side, sizes);
        if (size == 0) {
            continue;
        }
        GLOBAL StacklessNode *child = stackless_nodes + place;
        for (uint axis = 0; axis < 3; ++axis) {
            child->bounds[0][axis] = node->bounds[side][0][axis];
            child->bounds[1][axis] = node->bounds[side][1][axis];
        }
        place += size;
        child->escape = place;
        child->leaf = (node->child[side] & BVH_LEAF_BIT) != 0 ? node->child[side] : 0u;
    }
}
