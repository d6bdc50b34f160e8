// SPDX-License-Identifier: MIT
// The two-wide tree in depth-first order (shared/stackless_node.h): count_subtrees (one work-item) -> write_stackless_nodes (a
// work-item per node) -> link_stackless_nodes (one). The builder numbers parents before their children, which makes both sums single passes.
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

static void write_box(GLOBAL StacklessNode *stackless, GLOBAL const float (*bounds)[3]) {
    for (uint axis = 0; axis < 3; ++axis) {
        stackless->bounds[0][axis] = bounds[0][axis];
        stackless->bounds[1][axis] = bounds[1][axis];
    }
}

/// The octants, as bits, in which the right child is the nearer: by the axis along which the middles of both are farthest apart.
static uint octants_right_first(GLOBAL const BvhNode *node) {
    uint widest = 0;
    float distance = 0.0f;
    for (uint axis = 0; axis < 3; ++axis) {
        const float apart = (node->bounds[1][0][axis] + node->bounds[1][1][axis]) -
                            (node->bounds[0][0][axis] + node->bounds[0][1][axis]);
        if (fabs(apart) > fabs(distance)) {
            widest = axis;
            distance = apart;
        }
    }
    const uint towards_lower[3] = {0xaau, 0xccu, 0xf0u};  // octants whose bit of that axis is set (traverse_stackless.h)
    return distance >= 0.0f ? towards_lower[widest] : ~towards_lower[widest] & 0xffu;
}

/// Writes the boxes and leaves of the children of a node, and what it knows of them; the root's work-item writes the root, too.
__kernel void write_stackless_nodes(GLOBAL const BvhNode *nodes, uint node_count, GLOBAL const uint *sizes,
                                    GLOBAL const uint *places, GLOBAL StacklessNode *stackless_nodes) {
    const uint index = (uint)get_global_id(0);
    if (index >= node_count) {
        return;
    }
    GLOBAL const BvhNode *node = nodes + index;
    GLOBAL StacklessNode *stackless = stackless_nodes + places[index];
    if (index == 0) {
        for (uint axis = 0; axis < 3; ++axis) {
            stackless->bounds[0][axis] = lesser(node->bounds[0][0][axis], node->bounds[1][0][axis]);
            stackless->bounds[1][axis] = greater(node->bounds[0][1][axis], node->bounds[1][1][axis]);
        }
    }
    const bool has_right = node->count[1] > 0;
    uint place = places[index] + 1u;
    stackless->link = has_right ? place + child_size(node, 0, sizes) : sizes[0];
    stackless->right_first = has_right ? octants_right_first(node) : 0u;
    for (uint side = 0; side < 2; ++side) {
        const uint size = child_size(node, side, sizes);
        if (size > 0) {
            write_box(stackless_nodes + place, node->bounds[side]);
            if ((node->child[side] & BVH_LEAF_BIT) != 0) {
                stackless_nodes[place].link = node->child[side];
                stackless_nodes[place].right_first = 0;
            }
        }
        place += size;
    }
}

/// One work-item, parents first: from the child that comes first the way goes on to the other, and from there where it goes on
/// from their parent.
__kernel void link_stackless_nodes(GLOBAL const uint *sizes, GLOBAL StacklessNode *nodes) {
    if (get_global_id(0) != 0) {
        return;
    }
    const uint count = sizes[0];
    for (uint octant = 0; octant < 8; ++octant) {
        nodes->escape[octant] = count;
    }
    for (uint place = 0; place < count; ++place) {
        const uint left = place + 1u;
        const uint right = nodes[place].link;
        if ((right & BVH_LEAF_BIT) != 0 || left == count) {
            continue;
        }
        for (uint octant = 0; octant < 8; ++octant) {
            const bool right_first = (nodes[place].right_first >> octant & 1u) != 0;
            const uint after = nodes[place].escape[octant];
            nodes[left].escape[octant] = right_first ? after : right;
            if (right < count) {
                nodes[right].escape[octant] = right_first ? left : after;
            }
        }
    }
}
