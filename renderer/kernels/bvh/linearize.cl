// SPDX-License-Identifier: MIT
// Stages that convert a two-wide tree to the layout of stackless traversal
// (shared/stackless_node.h).
//
// link_parents, count_subtrees, place_subtree_nodes (depth-first order) and write_stackless_nodes,
// each with one work-item per node. A node with more triangles than the subtree size has its own
// work-item. The highest nodes below such nodes process their full subtree.
#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/shared/stackless_node.h"

/// Returns whether child `side` is a node, not a leaf.
static bool has_node(GLOBAL const BvhNode *node, uint side) {
    return (node->child[side] & BVH_LEAF_BIT) == 0;
}

/// Returns whether a node has more triangles than the subtree size.
static bool is_large(GLOBAL const BvhNode *node, uint subtree_size) {
    return node->count[0] + node->count[1] > subtree_size;
}

/// Returns whether the work-item of a node has work: the node is large, or it is the highest node
/// of a small subtree.
static bool is_first(GLOBAL const BvhNode *nodes, GLOBAL const uint *parents, uint index,
                     uint subtree_size) {
    return is_large(nodes + index, subtree_size) || parents[index] == BVH_NO_PARENT ||
           is_large(nodes + (parents[index] >> 1), subtree_size);
}

/// Returns the number of nodes in the subtree of child `side`.
static uint child_size(GLOBAL const BvhNode *node, uint side, GLOBAL const uint *sizes) {
    return has_node(node, side) ? sizes[node->child[side]] : 0u;
}

/// Writes the parents, as 2 x index + side, and initial sizes of one node each. count_subtrees adds
/// the nodes below.
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

/// Returns the node after `node` in depth-first order below `root`, or BVH_NO_PARENT after the last
/// one.
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

/// Computes subtree sizes. The work-item of a small subtree adds each of its nodes to all nodes
/// above that node within the subtree. It then adds the full subtree to the nodes above its root. A
/// large node adds itself.
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

/// Computes the index of every node in depth-first order.
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

/// Returns the octants, as bits, in which the right child is nearer. The axis along which the
/// centres of both children are farthest apart decides.
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
    // Octants whose bit of the axis is set (traverse_stackless.h).
    const uint towards_lower[3] = {0xaau, 0xccu, 0xf0u};
    return distance >= 0.0f ? towards_lower[widest] : ~towards_lower[widest] & 0xffu;
}

/// Returns an empty leaf after which traversal ends.
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

/// Finds for each octant the node that follows a node's subtree: the sibling of the first node, on
/// the path up, that comes before its sibling.
static void find_escapes(GLOBAL const BvhNode *nodes, GLOBAL const uint *parents,
                         GLOBAL const uint *places, uint index, PRIVATE uint *after) {
    for (uint octant = 0; octant < 8; ++octant) {
        after[octant] = 0;
    }
    uint open = 0xffu;  // octants without a result so far
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

/// Writes the children of a node, except the links to their own children, and the order of
/// traversal below the node. Traversal enters the child that comes first, continues with the other
/// child, and from there with the node that follows the parent's subtree. The root's work-item also
/// writes node 0.
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
