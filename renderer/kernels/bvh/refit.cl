// SPDX-License-Identifier: MIT
// Stages that refit a tree, of layout BVH_LAYOUT, whose triangles have moved.
//
// Once per tree: link_parents and find_depths (one work-item per node), a sort of the nodes by
// depth (radix_sort.cl), and find_levels (one per level). For each move: count_faults and
// refit_triangles (one per triangle or block of triangles), then refit_nodes level by level upwards
// (one per node).
//
// Bounds are exact: minimum and maximum of coordinates. Triangles that are not finite become
// triangles that nothing hits, and do not affect bounds.
#include "renderer/kernels/bvh/input_triangle.h"
#include "renderer/kernels/bvh/range_bounds.h"
#include "renderer/shared/bvh_layout.h"

/// Sets the parents of the nodes below a node. Node 0 is the root.
static void link_children(GLOBAL const BVH_NODE *nodes, uint index, GLOBAL uint *parents) {
#if BVH_LAYOUT == BVH_LAYOUT_STACKLESS
    if ((nodes[index].link & BVH_LEAF_BIT) == 0) {
        parents[nodes[index].link] = index;
        parents[nodes[index].link + 1u] = index;
    }
    if (index == 1) {  // node 1 is never read
        parents[index] = 0;
    }
#else
    for (uint i = 0; i < sizeof(nodes->child) / sizeof(uint); ++i) {
        const uint link = nodes[index].child[i];
        if (link != 0 && (link & BVH_LEAF_BIT) == 0) {
            parents[link] = index;
        }
    }
#endif
}

__kernel void link_parents(GLOBAL const BVH_NODE *nodes, uint node_count, GLOBAL uint *parents) {
    const uint index = (uint)get_global_id(0);
    if (index < node_count) {
        link_children(nodes, index, parents);
    }
}

/// Finds the depth of every node, and initialises the order to be sorted.
__kernel void find_depths(GLOBAL const uint *parents, uint node_count, GLOBAL ulong *depths,
                          GLOBAL uint *order) {
    const uint index = (uint)get_global_id(0);
    if (index >= node_count) {
        return;
    }
    uint depth = 0;
    for (uint node = index; node != 0; node = parents[node]) {
        ++depth;
    }
    depths[index] = depth;
    order[index] = index;
}

/// Finds for each depth the index of the first node, in sorted order, that is at least as deep.
__kernel void find_levels(GLOBAL const ulong *depths, uint node_count, uint level_count,
                          GLOBAL uint *levels) {
    const uint depth = (uint)get_global_id(0);
    if (depth >= level_count) {
        return;
    }
    uint begin = 0;
    uint end = node_count;
    while (begin < end) {
        const uint middle = begin + (end - begin) / 2u;
        if (depths[middle] < depth) {
            begin = middle + 1u;
        } else {
            end = middle;
        }
    }
    levels[depth] = begin;
}

/// Counts the triangles of the input that cannot be hit: `faults` by type (TriangleFault).
__kernel void count_faults(GLOBAL const float *positions, uint vertex_count,
                           GLOBAL const uint *indices, uint triangle_count, GLOBAL uint *faults) {
    const uint triangle = (uint)get_global_id(0);
    if (triangle >= triangle_count) {
        return;
    }
    PrimitiveRef ref;
    const TriangleFault fault = load_primitive(positions, vertex_count, indices, triangle, &ref);
    if (fault != TRIANGLE_GOOD) {
        atomic_add(faults + fault, 1u);
    }
}

/// Fetches the vertices of a triangle of the tree again, as [axis][vertex], and counts it if it
/// cannot be hit.
static void fetch_triangle(GLOBAL const float *positions, uint vertex_count,
                           GLOBAL const uint *indices, uint triangle, bool is_counted,
                           GLOBAL uint *faults, PRIVATE float (*coordinate)[3]) {
    PrimitiveRef ref;
    const TriangleFault fault = load_primitive(positions, vertex_count, indices, triangle, &ref);
    if (fault != TRIANGLE_GOOD && is_counted) {
        atomic_add(faults + fault, 1u);
    }
    for (uint corner = 0; corner < 3; ++corner) {
        const uint vertex = indices[3 * triangle + corner];
        for (uint axis = 0; axis < 3; ++axis) {
            coordinate[axis][corner] =
                fault == TRIANGLE_NOT_FINITE ? NAN : positions[3 * vertex + axis];
        }
    }
}

/// Writes the new vertices of a triangle, or of a block of triangles.
__kernel void refit_triangles(GLOBAL const float *positions, uint vertex_count,
                              GLOBAL const uint *indices, uint count,
                              GLOBAL BVH_TRIANGLES *triangles, GLOBAL uint *faults) {
    const uint index = (uint)get_global_id(0);
    if (index >= count) {
        return;
    }
    float coordinate[3][3];
#if BVH_LAYOUT == BVH_LAYOUT_WIDE8
    GLOBAL TriangleBlock *block = triangles + index;
    for (uint lane = 0; lane < WIDE_LANES; ++lane) {
        const bool is_repeated = lane > 0 && block->id[lane] == block->id[0];
        fetch_triangle(positions, vertex_count, indices, block->id[lane], !is_repeated, faults,
                       coordinate);
        for (uint axis = 0; axis < 3; ++axis) {
            for (uint vertex = 0; vertex < 3; ++vertex) {
                block->coordinate[axis][vertex][lane] = coordinate[axis][vertex];
            }
        }
    }
#else
    fetch_triangle(positions, vertex_count, indices, triangles[index].id, true, faults, coordinate);
    for (uint axis = 0; axis < 3; ++axis) {
        for (uint vertex = 0; vertex < 3; ++vertex) {
            triangles[index].coordinate[axis][vertex] = coordinate[axis][vertex];
        }
    }
#endif
}

/// Bounds along one axis. extend() ignores NaN.
typedef struct Interval {
    float lower, upper;
} Interval;

static void extend(PRIVATE Interval *interval, float lower, float upper) {
    interval->lower = lesser(interval->lower, lower);
    interval->upper = greater(interval->upper, upper);
}

/// Returns the bounds of everything below a link, which must not be empty.
static Interval bounds_below(GLOBAL const BVH_NODE *nodes, GLOBAL const BVH_TRIANGLES *triangles,
                             uint link, uint axis) {
    Interval all;
    all.lower = INFINITY;
    all.upper = -INFINITY;
#if BVH_LAYOUT == BVH_LAYOUT_WIDE8
    if ((link & BVH_LEAF_BIT) != 0) {
        GLOBAL const TriangleBlock *block = triangles + wide_leaf_block(link);
        for (uint vertex = 0; vertex < 3; ++vertex) {
            for (uint lane = 0; lane < WIDE_LANES; ++lane) {
                const float x = block->coordinate[axis][vertex][lane];
                extend(&all, x, x);
            }
        }
        return all;
    }
    for (uint lane = 0; lane < WIDE_LANES; ++lane) {
        extend(&all, nodes[link].bounds[0][axis][lane], nodes[link].bounds[1][axis][lane]);
    }
#else
    if ((link & BVH_LEAF_BIT) != 0) {
        for (uint i = 0; i < bvh_leaf_count(link); ++i) {
            for (uint vertex = 0; vertex < 3; ++vertex) {
                const float x = triangles[bvh_leaf_first(link) + i].coordinate[axis][vertex];
                extend(&all, x, x);
            }
        }
        return all;
    }
#if BVH_LAYOUT == BVH_LAYOUT_STACKLESS
    extend(&all, nodes[link].bounds[0][axis], nodes[link].bounds[1][axis]);
#else
    for (uint side = 0; side < 2; ++side) {
        extend(&all, nodes[link].bounds[side][0][axis], nodes[link].bounds[side][1][axis]);
    }
#endif
#endif
    return all;
}

/// Computes the bounds of a node from its triangles and from the bounds of the level below.
__kernel void refit_nodes(GLOBAL const uint *order, uint level_begin, uint level_end,
                          GLOBAL BVH_NODE *nodes, GLOBAL const BVH_TRIANGLES *triangles) {
    const uint place = level_begin + (uint)get_global_id(0);
    if (place >= level_end) {
        return;
    }
    const uint index = order[place];
    GLOBAL BVH_NODE *node = nodes + index;
    for (uint axis = 0; axis < 3; ++axis) {
#if BVH_LAYOUT == BVH_LAYOUT_STACKLESS
        Interval all = bounds_below(nodes, triangles, node->link, axis);
        if ((node->link & BVH_LEAF_BIT) == 0) {
            extend(&all, nodes[node->link + 1u].bounds[0][axis],
                   nodes[node->link + 1u].bounds[1][axis]);
        }
        node->bounds[0][axis] = all.lower;
        node->bounds[1][axis] = all.upper;
#elif BVH_LAYOUT == BVH_LAYOUT_WIDE8
        for (uint lane = 0; lane < WIDE_LANES; ++lane) {
            if (node->child[lane] != 0) {
                const Interval all = bounds_below(nodes, triangles, node->child[lane], axis);
                node->bounds[0][axis][lane] = all.lower;
                node->bounds[1][axis][lane] = all.upper;
            }
        }
#else
        for (uint side = 0; side < 2; ++side) {
            if (node->count[side] > 0) {
                const Interval all = bounds_below(nodes, triangles, node->child[side], axis);
                node->bounds[side][0][axis] = all.lower;
                node->bounds[side][1][axis] = all.upper;
            }
        }
#endif
    }
}
