// SPDX-License-Identifier: MIT
// Stages that assemble the finished tree of the clustering builder: nodes in depth-first order,
// with nodes of at most four triangles turned into leaves.
//
// place_clusters (one work-item per node location): above the subtree size, a node finds its index
// by following its parents to the root. The highest node below that size finds the index of its
// subtree and then walks down. fill_triangles follows (one work-item per triangle), then sum_costs
// and sum_cost.
#include "renderer/kernels/bvh/finished_tree.h"
#include "renderer/kernels/bvh/hploc.h"

/// A node of the clusters, with the location of the finished node and of its first triangle.
typedef struct Placed {
    uint cluster;
    uint node;
    uint first;
} Placed;

/// Returns the number of nodes of the finished tree below a link.
static uint nodes_below(GLOBAL const ClusterNode *cluster_nodes, uint link) {
    return (link & BVH_LEAF_BIT) != 0 ? 0u : cluster_nodes[link].nodes;
}

/// Finds the location of a node by following its parents to the root.
static Placed find_place(GLOBAL const BvhNode *nodes, GLOBAL const ClusterNode *cluster_nodes,
                         uint cluster) {
    Placed placed;
    placed.cluster = cluster;
    placed.node = 0;
    placed.first = 0;
    for (uint up = cluster_nodes[cluster].parent; up != BVH_NO_PARENT;
         up = cluster_nodes[up >> 1].parent) {
        placed.node += 1u;
        if ((up & 1u) != 0) {
            placed.node += nodes_below(cluster_nodes, nodes[up >> 1].child[0]);
            placed.first += nodes[up >> 1].count[0];
        }
    }
    return placed;
}

/// Lists the triangles of a leaf, at most four, in depth-first order.
static void list_triangles(GLOBAL const BvhNode *nodes, uint link, GLOBAL uint *order) {
    uint pending[BVH_LEAF_SIZE];
    uint size = 1;
    pending[0] = link;
    while (size > 0) {
        --size;
        const uint next = pending[size];
        if ((next & BVH_LEAF_BIT) != 0) {
            *order = next & ~BVH_LEAF_BIT;
            ++order;
        } else {
            pending[size] = nodes[next].child[1];
            pending[size + 1u] = nodes[next].child[0];
            size += 2u;
        }
    }
}

/// Writes a finished node and the triangles of its leaves. Sets `child` to the child nodes and
/// their locations, with BVH_EMPTY_LEAF for leaves.
static void write_node(GLOBAL const BvhNode *nodes, GLOBAL const ClusterNode *cluster_nodes,
                       Placed placed, GLOBAL BvhNode *finished, GLOBAL uint *order,
                       PRIVATE Placed child[2]) {
    BvhNode node = nodes[placed.cluster];
    child[0].node = placed.node + 1u;
    child[0].first = placed.first;
    child[1].node = placed.node + 1u + nodes_below(cluster_nodes, node.child[0]);
    child[1].first = placed.first + node.count[0];
    for (uint side = 0; side < 2; ++side) {
        if (node.count[side] <= BVH_LEAF_SIZE) {
            list_triangles(nodes, node.child[side], order + child[side].first);
            node.child[side] = bvh_leaf(child[side].first, node.count[side]);
            child[side].cluster = BVH_EMPTY_LEAF;
        } else {
            child[side].cluster = node.child[side];
            node.child[side] = child[side].node;
        }
    }
    finished[placed.node] = node;
}

/// Writes the finished nodes. The tree must not be deeper than traversal permits.
__kernel void place_clusters(GLOBAL const BvhNode *nodes, GLOBAL const ClusterNode *cluster_nodes,
                             uint count, uint subtree_size, GLOBAL BvhNode *finished,
                             GLOBAL uint *order) {
    const uint index = (uint)get_global_id(0);
    if (index >= count || cluster_nodes[index].count <= BVH_LEAF_SIZE) {
        return;
    }
    const uint parent = cluster_nodes[index].parent;
    const bool is_large = cluster_nodes[index].count > subtree_size;
    if (!is_large && parent != BVH_NO_PARENT && cluster_nodes[parent >> 1].count <= subtree_size) {
        return;
    }
    Placed pending[BVH_STACK_SIZE];
    uint size = 1;
    pending[0] = find_place(nodes, cluster_nodes, index);
    while (size > 0) {
        --size;
        Placed child[2];
        write_node(nodes, cluster_nodes, pending[size], finished, order, child);
        for (uint side = 2; side-- > 0 && !is_large;) {
            if (child[side].cluster != BVH_EMPTY_LEAF) {
                pending[size] = child[side];
                ++size;
            }
        }
    }
}

__kernel void fill_triangles(GLOBAL const uint *order, uint count, GLOBAL const float *positions,
                             GLOBAL const uint *indices, GLOBAL LeafTriangle *triangles) {
    const uint slot = (uint)get_global_id(0);
    if (slot >= count) {
        return;
    }
    triangles[slot] = leaf_triangle(positions, indices, order[slot]);
}

/// Sums the areas of the children of nodes, with those of leaves times their triangles, in squared
/// scene extents.
__kernel void sum_costs(GLOBAL const BvhNode *nodes, uint node_count,
                        GLOBAL const BuildState *state, GLOBAL float *costs) {
    const uint block = (uint)get_global_id(0);
    const uint begin = block * BVH_COST_BLOCK;
    if (begin >= node_count) {
        return;
    }
    const uint end = min(begin + BVH_COST_BLOCK, node_count);
    float cost = 0.0f;
    for (uint i = begin; i < end; ++i) {
        for (uint side = 0; side < 2; ++side) {
            const float area = node_child_area(nodes + i, side, state->inverse_extent);
            const bool is_leaf = (nodes[i].child[side] & BVH_LEAF_BIT) != 0;
            cost += area * (is_leaf ? (float)nodes[i].count[side] : 1.0f);
        }
    }
    costs[block] = cost;
}

/// Sums the cost of the tree. One work-item.
__kernel void sum_cost(GLOBAL const float *costs, uint node_count, GLOBAL BuildState *state) {
    if (get_global_id(0) != 0) {
        return;
    }
    float cost = state->root_area;
    for (uint block = 0; block * BVH_COST_BLOCK < node_count; ++block) {
        cost += costs[block];
    }
    state->cost = state->root_area > 0.0f ? cost / state->root_area : 0.0f;
}
