// SPDX-License-Identifier: MIT
// The finished tree: top nodes first, then subtree after subtree. place_subtrees (one work-item) numbers them
// and links them to the top nodes, copy_top_nodes and copy_subtrees (a work-item per subtree) write the
// compact arrays.
#include "renderer/kernels/bvh/finished_tree.h"

/// Without top nodes the root is a subtree; when that is a single leaf, or nothing at all, it is given a node
/// here.
__kernel void place_subtrees(GLOBAL BuildState *state, GLOBAL BuildSubtree *subtrees, uint subtree_count,
                             GLOBAL BvhNode *top_nodes) {
    if (get_global_id(0) != 0) {
        return;
    }
    BuildState total = *state;
    const bool root_is_leaf = total.top_node_count == 0 && subtrees[0].node_count == 0;
    if (root_is_leaf) {
        const RangeBounds all = subtrees[0].bounds;
        const RangeBounds nothing = empty_bounds();
        write_child(top_nodes, 0, &all, total.primitive_count, bvh_leaf(0, total.primitive_count));
        write_child(top_nodes, 1, &nothing, 0, BVH_EMPTY_LEAF);
        total.top_node_count = 1;
    }
    total.node_count = total.top_node_count;
    float cost = total.root_area;
    for (uint i = 0; i < subtree_count; ++i) {
        GLOBAL BuildSubtree *subtree = subtrees + i;
        subtree->node_offset = total.node_count;
        if (subtree->parent != BVH_NO_PARENT) {
            top_nodes[subtree->parent].child[subtree->side] =
                subtree->node_count > 0 ? total.node_count
                                        : bvh_leaf(subtree->begin, subtree->end - subtree->begin);
        }
        total.node_count += subtree->node_count;
        total.leaf_count += subtree->leaf_count;
        total.depth = max(total.depth, root_is_leaf ? 1u : subtree->deepest_leaf);
        cost += subtree->cost;
    }
    for (uint node = 0; node < total.top_node_count; ++node) {
        for (uint side = 0; side < 2; ++side) {
            const uint link = top_nodes[node].child[side];
            const float triangles = (link & BVH_LEAF_BIT) != 0 ? (float)bvh_leaf_count(link) : 1.0f;
            cost += node_child_area(top_nodes + node, side, total.inverse_extent) * triangles;
        }
    }
    total.cost = total.root_area > 0.0f ? cost / total.root_area : 0.0f;
    *state = total;
}

__kernel void copy_top_nodes(GLOBAL const BvhNode *top_nodes, uint top_node_count, GLOBAL BvhNode *nodes) {
    const uint index = (uint)get_global_id(0);
    if (index < top_node_count) {
        nodes[index] = top_nodes[index];
    }
}

__kernel void copy_subtrees(GLOBAL const BuildSubtree *subtrees, uint subtree_count,
                            GLOBAL const BvhNode *scratch_nodes, GLOBAL const PrimitiveRef *primitives_0,
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
