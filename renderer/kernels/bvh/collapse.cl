// SPDX-License-Identifier: MIT
// Stages that collapse a two-wide tree to nodes of eight children, level by level.
//
// For each level: open_wide_nodes (one work-item per node of the level); prefix sums of the number
// of each node's children that are nodes, then of those that are leaves; link_wide_nodes (one
// work-item per node). At the end: fill_blocks (one work-item per leaf). Numbering depends on the
// tree alone, not on scheduling.
//
// A wide node opens its child of largest area, which is proportional to the probability that a ray
// enters it, until it has eight children or only leaves: I. Wald, C. Benthin, S. Boulos, RT 2008. A
// subtree of at most eight triangles, which are tested at once, is a leaf.
#include "renderer/kernels/bvh/collapse.h"
#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/shared/triangle.h"

/// A child of a node of the two-wide tree.
typedef struct Candidate {
    uint node, side;  ///< the node whose child it is, and the child's side
    uint begin;       ///< first of its triangles
    uint count;
    float area;
} Candidate;

static Candidate make_candidate(GLOBAL const BvhNode *nodes, uint node, uint side, uint begin) {
    Candidate candidate;
    candidate.node = node;
    candidate.side = side;
    candidate.begin = begin;
    candidate.count = nodes[node].count[side];
    GLOBAL const float(*bounds)[3] = nodes[node].bounds[side];
    candidate.area = half_area(bounds[1][0] - bounds[0][0], bounds[1][1] - bounds[0][1],
                               bounds[1][2] - bounds[0][2], 1.0f);
    return candidate;
}

static void write_wide_child(GLOBAL WideNode *wide, uint lane, GLOBAL const float (*bounds)[3]) {
    for (uint axis = 0; axis < 3; ++axis) {
        wide->bounds[0][axis][lane] = bounds[0][axis];
        wide->bounds[1][axis][lane] = bounds[1][axis];
    }
}

static void write_no_child(GLOBAL WideNode *wide, uint lane) {
    for (uint axis = 0; axis < 3; ++axis) {
        wide->bounds[0][axis][lane] = INFINITY;
        wide->bounds[1][axis][lane] = -INFINITY;
    }
    wide->child[lane] = 0;
}

/// Writes node 0, which holds the scene's box and the link to the root, and the root's task or
/// leaf. One work-item.
__kernel void begin_collapse(GLOBAL const BvhNode *nodes, GLOBAL CollapseState *state,
                             GLOBAL WideNode *wide_nodes, GLOBAL WideTask *tasks,
                             GLOBAL WideLeaf *leaves) {
    if (get_global_id(0) != 0) {
        return;
    }
    const uint count = nodes->count[0] + nodes->count[1];
    for (uint lane = 0; lane < WIDE_LANES; ++lane) {
        write_no_child(wide_nodes, lane);
    }
    for (uint axis = 0; axis < 3; ++axis) {
        wide_nodes->bounds[0][axis][0] =
            lesser(nodes->bounds[0][0][axis], nodes->bounds[1][0][axis]);
        wide_nodes->bounds[1][axis][0] =
            greater(nodes->bounds[0][1][axis], nodes->bounds[1][1][axis]);
    }
    CollapseState begin;
    begin.node_count = 1;
    begin.leaf_count = 0;
    if (count > WIDE_LANES) {
        wide_nodes->child[0] = 1;
        tasks[1].node = 0;
        tasks[1].begin = 0;
        begin.node_count = 2;
    } else if (count > 0) {
        wide_nodes->child[0] = wide_leaf(0, count);
        leaves[0].begin = 0;
        leaves[0].count = count;
        begin.leaf_count = 1;
    }
    *state = begin;
}

/// Selects the children of the nodes of this level. Writes to `counts`, for all nodes, how many of
/// their children are nodes, then how many are leaves, then 0.
__kernel void open_wide_nodes(GLOBAL const BvhNode *nodes, uint level_begin, uint level_end,
                              GLOBAL WideNode *wide_nodes, GLOBAL WideTask *tasks,
                              GLOBAL uint *counts) {
    const uint index = level_begin + (uint)get_global_id(0);
    if (index >= level_end) {
        return;
    }
    GLOBAL WideTask *task = tasks + index;
    Candidate children[WIDE_LANES];
    children[0] = make_candidate(nodes, task->node, 0, task->begin);
    children[1] = make_candidate(nodes, task->node, 1, task->begin + children[0].count);
    uint count = 2;
    while (count < WIDE_LANES) {
        uint largest = WIDE_LANES;
        float area = -1.0f;
        for (uint i = 0; i < count; ++i) {
            if (children[i].count > WIDE_LANES && children[i].area > area) {
                largest = i;
                area = children[i].area;
            }
        }
        if (largest == WIDE_LANES) {
            break;
        }
        const Candidate opened = children[largest];
        const uint node = nodes[opened.node].child[opened.side];
        children[largest] = make_candidate(nodes, node, 0, opened.begin);
        children[count] = make_candidate(nodes, node, 1, opened.begin + children[largest].count);
        ++count;
    }
    GLOBAL WideNode *wide = wide_nodes + index;
    uint inner = 0;
    for (uint lane = 0; lane < WIDE_LANES; ++lane) {
        if (lane >= count) {
            write_no_child(wide, lane);
            continue;
        }
        const Candidate child = children[lane];
        const bool is_leaf = child.count <= WIDE_LANES;
        write_wide_child(wide, lane, nodes[child.node].bounds[child.side]);
        // Temporary link, which link_wide_nodes replaces: the two-wide node, or the size of the
        // leaf.
        wide->child[lane] =
            is_leaf ? wide_leaf(0, child.count) : nodes[child.node].child[child.side];
        task->child_begin[lane] = child.begin;
        inner += is_leaf ? 0u : 1u;
    }
    task->child_count = count;
    const uint place = index - level_begin;
    const uint level_size = level_end - level_begin;
    counts[place] = inner;
    counts[level_size + place] = count - inner;
    if (place == 0) {
        counts[2u * level_size] = 0;
    }
}

/// Links the nodes of this level to their children. `sums` are the exclusive prefix sums of the
/// counts. The first work-item adds the level to the state.
__kernel void link_wide_nodes(uint level_begin, uint level_end, uint first_leaf,
                              GLOBAL const uint *sums, GLOBAL CollapseState *state,
                              GLOBAL WideNode *wide_nodes, GLOBAL WideTask *tasks,
                              GLOBAL WideLeaf *leaves) {
    const uint index = level_begin + (uint)get_global_id(0);
    if (index >= level_end) {
        return;
    }
    const uint place = index - level_begin;
    const uint level_size = level_end - level_begin;
    const uint all_inner = sums[level_size];
    if (place == 0) {
        state->node_count = level_end + all_inner;
        state->leaf_count = first_leaf + sums[2u * level_size] - all_inner;
    }
    GLOBAL const WideTask *task = tasks + index;
    GLOBAL WideNode *wide = wide_nodes + index;
    uint inner = level_end + sums[place];
    uint leaf = first_leaf + sums[level_size + place] - all_inner;
    for (uint lane = 0; lane < task->child_count; ++lane) {
        const uint link = wide->child[lane];
        if ((link & BVH_LEAF_BIT) != 0) {
            leaves[leaf].begin = task->child_begin[lane];
            leaves[leaf].count = wide_leaf_count(link);
            wide->child[lane] = link | leaf;
            ++leaf;
        } else {
            tasks[inner].node = link;
            tasks[inner].begin = task->child_begin[lane];
            wide->child[lane] = inner;
            ++inner;
        }
    }
}

__kernel void fill_blocks(GLOBAL const WideLeaf *leaves, uint leaf_count,
                          GLOBAL const LeafTriangle *triangles, GLOBAL TriangleBlock *blocks) {
    const uint index = (uint)get_global_id(0);
    if (index >= leaf_count) {
        return;
    }
    const WideLeaf leaf = leaves[index];
    GLOBAL TriangleBlock *block = blocks + index;
    for (uint lane = 0; lane < WIDE_LANES; ++lane) {
        GLOBAL const LeafTriangle *triangle =
            triangles + leaf.begin + (lane < leaf.count ? lane : 0u);
        for (uint axis = 0; axis < 3; ++axis) {
            for (uint vertex = 0; vertex < 3; ++vertex) {
                block->coordinate[axis][vertex][lane] = triangle->coordinate[axis][vertex];
            }
        }
        block->id[lane] = triangle->id;
    }
}

__kernel void copy_wide_nodes(GLOBAL const WideNode *scratch, uint node_count,
                              GLOBAL WideNode *wide_nodes) {
    const uint index = (uint)get_global_id(0);
    if (index < node_count) {
        wide_nodes[index] = scratch[index];
    }
}
