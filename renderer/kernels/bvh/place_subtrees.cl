// SPDX-License-Identifier: MIT
// Stages that assemble the finished tree of the binned builder: top nodes first, then subtree after
// subtree.
//
// place_subtrees (one work-group) numbers the subtrees and links them to the top nodes.
// copy_top_nodes and copy_subtrees (one work-item per node or subtree) write the compact arrays.
#include "renderer/kernels/bvh/finished_tree.h"
#include "renderer/kernels/bvh/one_group.h"

/// Numbers the subtrees, links them and sums up the tree's statistics. Without top nodes the root
/// is a subtree. If that is a single leaf or empty, it receives a node here.
__kernel void place_subtrees(GLOBAL BuildState *state, GLOBAL BuildSubtree *subtrees,
                             uint subtree_count, GLOBAL BvhNode *top_nodes) {
    __local uint shared[ONE_GROUP];
    __local float shared_cost[ONE_GROUP];
    const uint item = (uint)get_local_id(0);
    BuildState total = *state;
    const bool root_is_leaf = total.top_node_count == 0 && subtrees[0].node_count == 0;
    if (root_is_leaf) {
        total.top_node_count = 1;
        if (item == 0) {
            const RangeBounds all = subtrees[0].bounds;
            const RangeBounds nothing = empty_bounds();
            write_child(top_nodes, 0, &all, total.primitive_count,
                        bvh_leaf(0, total.primitive_count));
            write_child(top_nodes, 1, &nothing, 0, BVH_EMPTY_LEAF);
        }
    }
    total.node_count = total.top_node_count;
    float cost = item == 0 ? total.root_area : 0.0f;
    uint leaves = 0;
    uint depth = total.depth;
    for (uint first = 0; first < subtree_count; first += ONE_GROUP) {
        const uint i = first + item;
        GLOBAL BuildSubtree *subtree = subtrees + i;
        const uint nodes = i < subtree_count ? subtree->node_count : 0u;
        uint new_nodes;
        const uint offset = total.node_count + sum_before(shared, nodes, &new_nodes);
        if (i < subtree_count) {
            subtree->node_offset = offset;
            if (subtree->parent != BVH_NO_PARENT) {
                top_nodes[subtree->parent].child[subtree->side] =
                    nodes > 0 ? offset : bvh_leaf(subtree->begin, subtree->end - subtree->begin);
            }
            leaves += subtree->leaf_count;
            depth = max(depth, root_is_leaf ? 1u : subtree->deepest_leaf);
            cost += subtree->cost;
        }
        total.node_count += new_nodes;
    }
    uint new_leaves;
    sum_before(shared, leaves, &new_leaves);
    total.leaf_count += new_leaves;
    barrier(CLK_GLOBAL_MEM_FENCE);  // makes the links of top nodes visible
    for (uint node = item; node < total.top_node_count; node += ONE_GROUP) {
        for (uint side = 0; side < 2; ++side) {
            const uint link = top_nodes[node].child[side];
            const float triangles = (link & BVH_LEAF_BIT) != 0 ? (float)bvh_leaf_count(link) : 1.0f;
            cost += node_child_area(top_nodes + node, side, total.inverse_extent) * triangles;
        }
    }
    shared[item] = depth;
    shared_cost[item] = cost;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item != 0) {
        return;
    }
    for (uint i = 1; i < ONE_GROUP; ++i) {
        depth = max(depth, shared[i]);
        cost += shared_cost[i];
    }
    total.depth = depth;
    total.cost = total.root_area > 0.0f ? cost / total.root_area : 0.0f;
    *state = total;
}

__kernel void copy_top_nodes(GLOBAL const BvhNode *top_nodes, uint top_node_count,
                             GLOBAL BvhNode *nodes) {
    const uint index = (uint)get_global_id(0);
    if (index < top_node_count) {
        nodes[index] = top_nodes[index];
    }
}

__kernel void copy_subtrees(GLOBAL const BuildSubtree *subtrees, uint subtree_count,
                            GLOBAL const BvhNode *scratch_nodes,
                            GLOBAL const PrimitiveRef *primitives_0,
                            GLOBAL const PrimitiveRef *primitives_1, GLOBAL const float *positions,
                            GLOBAL const uint *indices, GLOBAL BvhNode *nodes,
                            GLOBAL LeafTriangle *triangles) {
    const uint index = (uint)get_global_id(0);
    if (index >= subtree_count) {
        return;
    }
    GLOBAL const BuildSubtree *subtree = subtrees + index;
    const uint offset = subtree->node_offset;
    for (uint i = 0; i < subtree->node_count; ++i) {
        BvhNode node = scratch_nodes[subtree->begin + i];
        for (uint side = 0; side < 2; ++side) {
            if ((node.child[side] & BVH_LEAF_BIT) == 0) {
                node.child[side] += offset;
            }
        }
        nodes[offset + i] = node;
    }
    GLOBAL const PrimitiveRef *primitives = subtree->buffer == 0 ? primitives_0 : primitives_1;
    for (uint slot = subtree->begin; slot < subtree->end; ++slot) {
        triangles[slot] = leaf_triangle(positions, indices, primitives[slot].triangle);
    }
}
