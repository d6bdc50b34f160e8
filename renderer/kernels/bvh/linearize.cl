// SPDX-License-Identifier: MIT
// The two-wide tree as traversal without a stack reads it (shared/stackless_node.h), a work-item
// per node in each stage: link_parents -> count_subtrees -> place_subtree_nodes (in depth-first
// order) -> write_stackless_nodes. Nodes that hold more than the subtree size of triangles are on
// their own, the highest below them answer for all of their subtree.
#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/shared/stackless_node.h"

static bool has_node(GLOBAL const BvhNode *node, uint side) {
    return (node->child[side] & BVH_LEAF_BIT) == 0;
}

static bool is_large(GLOBAL const BvhNode *node, uint subtree_size) {
    return node->count[0] + node->count[1] > subtree_size;
}

/// Whether a work-item has something to do: of the subtree size or below, nodes whose parent is
/// above.
static bool is_first(GLOBAL const BvhNode *nodes, GLOBAL const uint *parents, uint index,
                     uint subtree_size) {
    return is_large(nodes + index, subtree_size) || parents[index] == BVH_NO_PARENT ||
           is_large(nodes + (parents[index] >> 1), subtree_size);
}

/// Nodes below and including child `side`.
static uint child_size(GLOBAL const BvhNode *node, uint side, GLOBAL const uint *sizes) {
    return has_node(node, side) ? sizes[node->child[side]] : 0u;
}

/// `parents`: 2 x number + side. `sizes`: of the node alone; count_subtrees adds what is below.
__kernel void link_parents(GLOBAL const BvhNode *nodes, uint node_count, GLOBAL uint *parents,
                           GLOBAL uint *sizes) {
    const uint index = (uint)get_global_id(0);
    if (index >= node_count) {
        return;
    }
    for (uint side = 0; side < 2; ++side) {
        if (has_node(nodes + index, side)) {
            parents[nodes[index].child[side]] = 2u * index + side;
        }
    }
    if (index == 0) {
        parents[0] = BVH_NO_PARENT;
    }
    sizes[index] = 1;
}

/// The node after `node` in depth-first order, below `root`; BVH_NO_PARENT after the last one.
static uint next_node(GLOBAL const BvhNode *nodes, GLOBAL const uint *parents, uint root,
                      uint node) {
    for (uint side = 0; side < 2; ++side) {
        if (has_node(nodes + node, side)) {
            return nodes[node].child[side];
        }
    }
    while (node != root) {
        const uint up = parents[node];
        node = up >> 1;
        if ((up & 1u) == 0 && has_node(nodes + node, 1)) {
            return nodes[node].child[1];
        }
    }
    return BVH_NO_PARENT;
}

/// Counts every node with those above it, up to the first of its subtree, and the whole subtree
/// further up.
__kernel void count_subtrees(GLOBAL const BvhNode *nodes, uint node_count, uint subtree_size,
                             GLOBAL const uint *parents, GLOBAL uint *sizes) {
    const uint index = (uint)get_global_id(0);
    if (index >= node_count || !is_first(nodes, parents, index, subtree_size)) {
        return;
    }
    uint size = 1;
    if (!is_large(nodes + index, subtree_size)) {
        for (uint node = next_node(nodes, parents, index, index); node != BVH_NO_PARENT;
             node = next_node(nodes, parents, index, node)) {
            ++size;
            for (uint up = parents[node] >> 1; up != index; up = parents[up] >> 1) {
                ++sizes[up];
            }
        }
        sizes[index] = size;
    }
    for (uint up = parents[index]; up != BVH_NO_PARENT; up = parents[up >> 1]) {
        atomic_add(sizes + (up >> 1), size);
    }
}

/// The place of every node in depth-first order.
__kernel void place_subtree_nodes(GLOBAL const BvhNode *nodes, uint node_count, uint subtree_size,
                                  GLOBAL const uint *parents, GLOBAL const uint *sizes,
                                  GLOBAL uint *places) {
    const uint index = (uint)get_global_id(0);
    if (index >= node_count || !is_first(nodes, parents, index, subtree_size)) {
        return;
    }
    uint place = 0;
    for (uint up = parents[index]; up != BVH_NO_PARENT; up = parents[up >> 1]) {
        place += 1u + ((up & 1u) != 0 ? child_size(nodes + (up >> 1), 0, sizes) : 0u);
    }
    places[index] = place;
    if (is_large(nodes + index, subtree_size)) {
        return;
    }
    for (uint node = next_node(nodes, parents, index, index); node != BVH_NO_PARENT;
         node = next_node(nodes, parents, index, node)) {
        const uint up = parents[node] >> 1;
        places[node] =
            places[up] + 1u + ((parents[node] & 1u) != 0 ? child_size(nodes + up, 0, sizes) : 0u);
    }
}

static void write_box(GLOBAL StacklessNode *stackless, GLOBAL const float (*bounds)[3]) {
    for (uint axis = 0; axis < 3; ++axis) {
        stackless->bounds[0][axis] = bounds[0][axis];
        stackless->bounds[1][axis] = bounds[1][axis];
    }
}

/// The octants, as bits, in which the right child is the nearer: by the axis along which the
/// middles of both are farthest apart.
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
    const uint towards_lower[3] = {
        0xaau, 0xccu, 0xf0u};  // octants whose bit of that axis is set (traverse_stackless.h)
    return distance >= 0.0f ? towards_lower[widest] : ~towards_lower[widest] & 0xffu;
}

/// An empty leaf, from where the way ends.
static StacklessNode no_node(void) {
    StacklessNode node;
    for (uint axis = 0; axis < 3; ++axis) {
        node.bounds[0][axis] = INFINITY;
        node.bounds[1][axis] = -INFINITY;
    }
    node.link = BVH_EMPTY_LEAF;
    node.right_first = 0;
    for (uint octant = 0; octant < 8; ++octant) {
        node.escape[octant] = 0;
    }
    return node;
}

/// Where the way goes on after a node, by octant: the other child of the first one above, on the
/// way up, that comes first itself.
static void find_escapes(GLOBAL const BvhNode *nodes, GLOBAL const uint *parents,
                         GLOBAL const uint *places, uint index, PRIVATE uint *after) {
    for (uint octant = 0; octant < 8; ++octant) {
        after[octant] = 0;
    }
    uint open = 0xffu;  // octants for which it is not known yet
    for (uint up = parents[index]; up != BVH_NO_PARENT && open != 0; up = parents[up >> 1]) {
        const uint right_first = octants_right_first(nodes + (up >> 1));
        const uint found = open & ((up & 1u) != 0 ? right_first : ~right_first);
        const uint other = stackless_child(places[up >> 1], 1u - (up & 1u));
        for (uint octant = 0; octant < 8; ++octant) {
            after[octant] = (found >> octant & 1u) != 0 ? other : after[octant];
        }
        open &= ~found;
    }
}

/// Writes a node's children but for what they know of their own ones, and how the way goes on below
/// it: first to the child that comes first, from there to the other, and from that where it goes on
/// from the node. The root's work-item writes node 0, too.
__kernel void write_stackless_nodes(GLOBAL const BvhNode *nodes, uint node_count,
                                    GLOBAL const uint *parents, GLOBAL const uint *places,
                                    GLOBAL StacklessNode *stackless_nodes) {
    const uint index = (uint)get_global_id(0);
    if (index >= node_count) {
        return;
    }
    GLOBAL const BvhNode *node = nodes + index;
    GLOBAL StacklessNode *stackless = stackless_nodes;
    if (index > 0) {
        stackless += stackless_child(places[parents[index] >> 1], parents[index] & 1u);
    } else {
        stackless_nodes[0] = stackless_nodes[1] = no_node();
        for (uint axis = 0; axis < 3; ++axis) {
            stackless->bounds[0][axis] = lesser(node->bounds[0][0][axis], node->bounds[1][0][axis]);
            stackless->bounds[1][axis] =
                greater(node->bounds[0][1][axis], node->bounds[1][1][axis]);
        }
    }
    const uint left = stackless_child(places[index], 0);
    const uint right_first = octants_right_first(node);
    stackless->link = left;
    stackless->right_first = right_first;
    uint after[8];
    find_escapes(nodes, parents, places, index, after);
    for (uint side = 0; side < 2; ++side) {
        GLOBAL StacklessNode *child = stackless_nodes + left + side;
        write_box(child, node->bounds[side]);
        if (!has_node(node, side)) {
            child->link = node->child[side];
            child->right_first = 0;
        }
        for (uint octant = 0; octant < 8; ++octant) {
            const bool is_first = (right_first >> octant & 1u) == side;
            child->escape[octant] = is_first ? left + 1u - side : after[octant];
        }
    }
}
