// SPDX-License-Identifier: MIT
// Stages of the clustering builder (hploc.h), which merge clusters from the bottom up along the
// radix tree of their codes.
//
// begin_ranges (one work-item); divide_ranges, level by level (one work-item per range);
// cluster_subtrees (one per subtree); cluster_ranges, level by level upwards (one per range);
// cluster_root (one work-item).
#include "renderer/kernels/bvh/hploc.h"
#include "renderer/kernels/bvh/range_bounds.h"

#define WINDOW (2u * HPLOC_KEPT)

/// The clusters of one node of the radix tree, in order.
typedef struct Clusters {
    /// [lower, upper][x, y, z][cluster]; beyond the last cluster those of write_far_box.
    float box[2][3][WINDOW + HPLOC_RADIUS];
    uint link[WINDOW];   ///< link to a ClusterNode, or a leaf of one triangle
    uint place[WINDOW];  ///< location free for the node that it becomes part of
} Clusters;

/// Returns where the radix tree divides a range of at least two codes: before the first code with
/// the highest bit in which any two differ, or in the middle if all codes are equal.
static uint divide_codes(GLOBAL const ulong *codes, uint begin, uint end) {
    const ulong first = codes[begin];
    const ulong last = codes[end - 1u];
    if (first == last) {
        return begin + (end - begin) / 2u;
    }
    const ulong bit = 0x8000000000000000ul >> clz(first ^ last);
    uint low = begin;  // the code at `low` lacks the bit, that at `high` has it
    uint high = end - 1u;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if ((codes[middle] & bit) != 0) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return high;
}

/// Writes a box far larger than any other, whose area is finite.
static void write_far_box(PRIVATE Clusters *c, uint i) {
    for (uint axis = 0; axis < 3; ++axis) {
        c->box[0][axis][i] = -1.0e18f;
        c->box[1][axis][i] = 1.0e18f;
    }
}

/// Returns half the areas of the boxes that enclose cluster i and each of the eight clusters after
/// it.
static float8 union_areas(PRIVATE const Clusters *c, uint i) {
    float8 side[3];
    for (uint axis = 0; axis < 3; ++axis) {
        const float8 lower = vload8(0, c->box[0][axis] + i + 1u);
        const float8 upper = vload8(0, c->box[1][axis] + i + 1u);
        const float8 own_lower = splat_float8(c->box[0][axis][i]);
        const float8 own_upper = splat_float8(c->box[1][axis][i]);
        side[axis] =
            (upper > own_upper ? upper : own_upper) - (lower < own_lower ? lower : own_lower);
    }
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

/// Keys that order the pairs of clusters. The high bits of a key are the area without its four
/// lowest bits. The low bits are the distance of the pair in order, then the parity of its first
/// index. Among pairs of equal keys the first one wins. Thus there is always a pair that is the
/// best for both of its clusters. Among equal clusters, half of them are in such a pair.
CONSTANT uint behind[HPLOC_RADIUS] = {0, 2, 4, 6, 8, 10, 12, 14};

/// Returns the distance of the pair of a key.
static uint distance_of(uint key) {
    return ((key & 15u) >> 1) + 1u;
}

/// Finds the nearest neighbour of every cluster.
static void find_nearest(PRIVATE const Clusters *c, uint count, PRIVATE uint *nearest) {
    uint before[WINDOW + HPLOC_RADIUS];  // smallest key of a pair of which this is the second
    for (uint i = 0; i < count + HPLOC_RADIUS; ++i) {
        before[i] = 0xffffffffu;
    }
    for (uint i = 0; i < count; ++i) {
        uint8 keys = (as_uint8(union_areas(c, i)) & ~15u) | vload8(0, behind) | (i & 1u);
        vstore8(min(keys, vload8(0, before + i + 1u)), 0, before + i + 1u);
        uint lanes[HPLOC_RADIUS];
        vstore8(keys, 0, lanes);
        uint after = lanes[0];
        for (uint lane = 1; lane < HPLOC_RADIUS; ++lane) {
            after = min(after, lanes[lane]);
        }
        nearest[i] = before[i] <= after ? i - distance_of(before[i]) : i + distance_of(after);
    }
}

/// Returns the node of a cluster, also for a single triangle.
static ClusterNode cluster_node(GLOBAL const ClusterNode *cluster_nodes, uint link) {
    ClusterNode node;
    node.count = 1;
    node.nodes = 0;
    node.height = 0;
    node.parent = BVH_NO_PARENT;
    if ((link & BVH_LEAF_BIT) == 0) {
        node = cluster_nodes[link];
    }
    return node;
}

/// Merges clusters `a` and `b` into cluster `to`, and writes their node.
static void unite(PRIVATE Clusters *c, uint a, uint b, GLOBAL BvhNode *nodes,
                  GLOBAL ClusterNode *cluster_nodes, uint to) {
    const uint number = c->place[a];
    GLOBAL BvhNode *node = nodes + number;
    for (uint axis = 0; axis < 3; ++axis) {
        node->bounds[0][0][axis] = c->box[0][axis][a];
        node->bounds[0][1][axis] = c->box[1][axis][a];
        node->bounds[1][0][axis] = c->box[0][axis][b];
        node->bounds[1][1][axis] = c->box[1][axis][b];
        c->box[0][axis][to] = lesser(c->box[0][axis][a], c->box[0][axis][b]);
        c->box[1][axis][to] = greater(c->box[1][axis][a], c->box[1][axis][b]);
    }
    node->child[0] = c->link[a];
    node->child[1] = c->link[b];
    const ClusterNode first = cluster_node(cluster_nodes, c->link[a]);
    const ClusterNode second = cluster_node(cluster_nodes, c->link[b]);
    node->count[0] = first.count;
    node->count[1] = second.count;
    if ((c->link[a] & BVH_LEAF_BIT) == 0) {
        cluster_nodes[c->link[a]].parent = 2u * number;
    }
    if ((c->link[b] & BVH_LEAF_BIT) == 0) {
        cluster_nodes[c->link[b]].parent = 2u * number + 1u;
    }
    ClusterNode both;
    both.count = first.count + second.count;
    const bool is_leaf = both.count <= BVH_LEAF_SIZE;
    both.nodes = is_leaf ? 0u : 1u + first.nodes + second.nodes;
    both.height = is_leaf ? 0u : 1u + max(first.height, second.height);
    both.parent = BVH_NO_PARENT;
    cluster_nodes[number] = both;
    c->link[to] = number;
    c->place[to] = c->place[b];
}

static void copy_cluster(PRIVATE Clusters *c, uint from, uint to) {
    for (uint axis = 0; axis < 3; ++axis) {
        c->box[0][axis][to] = c->box[0][axis][from];
        c->box[1][axis][to] = c->box[1][axis][from];
    }
    c->link[to] = c->link[from];
    c->place[to] = c->place[from];
}

static void load_clusters(PRIVATE Clusters *c, uint to, GLOBAL const PrimitiveRef *clusters,
                          uint count) {
    for (uint i = 0; i < count; ++i, ++to) {
        const PrimitiveRef cluster = clusters[i];
        for (uint axis = 0; axis < 3; ++axis) {
            c->box[0][axis][to] = cluster.lower[axis];
            c->box[1][axis][to] = cluster.upper[axis];
        }
        c->link[to] = cluster.triangle;
        c->place[to] = cluster.padding;
    }
}

/// Merges the clusters of [begin, middle) and [middle, end) until at most `target` are left, and
/// writes them from `begin` on. The clusters are the first `left` entries of the first range and
/// the first `right` entries of the second. Returns the number of clusters left.
static uint cluster(GLOBAL PrimitiveRef *clusters, uint begin, uint left, uint middle, uint right,
                    uint target, GLOBAL BvhNode *nodes, GLOBAL ClusterNode *cluster_nodes) {
    Clusters c;
    load_clusters(&c, 0, clusters + begin, left);
    load_clusters(&c, left, clusters + middle, right);
    uint count = left + right;
    while (count > target) {
        for (uint i = count; i < count + HPLOC_RADIUS; ++i) {
            write_far_box(&c, i);
        }
        uint nearest[WINDOW];
        find_nearest(&c, count, nearest);
        uint next = 0;
        for (uint i = 0; i < count; ++i) {
            const uint other = nearest[i];
            if (nearest[other] != i) {
                copy_cluster(&c, i, next);
                ++next;
            } else if (i < other) {
                unite(&c, i, other, nodes, cluster_nodes, next);
                ++next;
            }
        }
        count = next;
    }
    for (uint i = 0; i < count; ++i) {
        PrimitiveRef kept;
        for (uint axis = 0; axis < 3; ++axis) {
            kept.lower[axis] = c.box[0][axis][i];
            kept.upper[axis] = c.box[1][axis][i];
        }
        kept.triangle = c.link[i];
        kept.padding = c.place[i];
        clusters[begin + i] = kept;
    }
    return count;
}

/// Returns the number of clusters of a range: all its primitives, or those left by merging.
static uint kept_of(GLOBAL const uint *kept, uint begin, uint end) {
    return end - begin <= HPLOC_KEPT ? end - begin : kept[begin];
}

/// Registers a range for the next level, or as a subtree. Does nothing if the range's primitives
/// are its clusters. The order of ranges and subtrees does not matter.
static void book_range(GLOBAL ClusterState *state, GLOBAL CodeRange *ranges,
                       GLOBAL CodeSubtree *subtrees, uint subtree_size, uint begin, uint end) {
    if (end - begin > subtree_size) {
        GLOBAL CodeRange *range = ranges + atomic_add(&state->range_count, 1u);
        range->begin = begin;
        range->end = end;
    } else if (end - begin > HPLOC_KEPT) {
        GLOBAL CodeSubtree *subtree = subtrees + atomic_add(&state->subtree_count, 1u);
        subtree->begin = begin;
        subtree->end = end;
    }
}

__kernel void begin_ranges(GLOBAL ClusterState *state, GLOBAL CodeRange *ranges,
                           GLOBAL CodeSubtree *subtrees, uint subtree_size, uint count) {
    if (get_global_id(0) != 0) {
        return;
    }
    state->range_count = 0;
    state->subtree_count = 0;
    state->root = 0;
    state->node_count = 0;
    state->depth = 0;
    book_range(state, ranges, subtrees, subtree_size, 0, count);
}

/// Divides the ranges of a level and registers their halves.
__kernel void divide_ranges(GLOBAL const ulong *codes, uint level_begin, uint level_end,
                            uint subtree_size, GLOBAL ClusterState *state, GLOBAL CodeRange *ranges,
                            GLOBAL CodeSubtree *subtrees) {
    const uint index = level_begin + (uint)get_global_id(0);
    if (index >= level_end) {
        return;
    }
    const uint begin = ranges[index].begin;
    const uint end = ranges[index].end;
    const uint middle = divide_codes(codes, begin, end);
    ranges[index].middle = middle;
    book_range(state, ranges, subtrees, subtree_size, begin, middle);
    book_range(state, ranges, subtrees, subtree_size, middle, end);
}

/// Merges the clusters of a small range, depth first.
__kernel void cluster_subtrees(GLOBAL const CodeSubtree *subtrees, uint subtree_count,
                               GLOBAL const ulong *codes, GLOBAL PrimitiveRef *clusters,
                               GLOBAL uint *kept, GLOBAL BvhNode *nodes,
                               GLOBAL ClusterNode *cluster_nodes) {
    const uint index = (uint)get_global_id(0);
    if (index >= subtree_count) {
        return;
    }
    // On the path down to the current range, each level has that range and a sibling that waits.
    CodeRange pending[2u * HPLOC_LEVELS];
    uint size = 1;
    pending[0].begin = subtrees[index].begin;
    pending[0].middle = BVH_NO_PARENT;
    pending[0].end = subtrees[index].end;
    while (size > 0) {
        const CodeRange range = pending[size - 1u];
        const uint count = range.end - range.begin;
        if (count <= 2u * HPLOC_KEPT) {
            kept[range.begin] = cluster(clusters, range.begin, count, range.end, 0, HPLOC_KEPT,
                                        nodes, cluster_nodes);
            --size;
        } else if (range.middle != BVH_NO_PARENT) {
            const uint left = kept_of(kept, range.begin, range.middle);
            const uint right = kept_of(kept, range.middle, range.end);
            kept[range.begin] = cluster(clusters, range.begin, left, range.middle, right,
                                        HPLOC_KEPT, nodes, cluster_nodes);
            --size;
        } else {
            const uint middle = divide_codes(codes, range.begin, range.end);
            pending[size - 1u].middle = middle;
            if (middle - range.begin > HPLOC_KEPT) {
                pending[size].begin = range.begin;
                pending[size].middle = BVH_NO_PARENT;
                pending[size].end = middle;
                ++size;
            }
            if (range.end - middle > HPLOC_KEPT) {
                pending[size].begin = middle;
                pending[size].middle = BVH_NO_PARENT;
                pending[size].end = range.end;
                ++size;
            }
        }
    }
}

/// Merges the clusters of the halves of a range.
__kernel void cluster_ranges(GLOBAL const CodeRange *ranges, uint level_begin, uint level_end,
                             GLOBAL PrimitiveRef *clusters, GLOBAL uint *kept,
                             GLOBAL BvhNode *nodes, GLOBAL ClusterNode *cluster_nodes) {
    const uint index = level_begin + (uint)get_global_id(0);
    if (index >= level_end) {
        return;
    }
    const CodeRange range = ranges[index];
    const uint left = kept_of(kept, range.begin, range.middle);
    const uint right = kept_of(kept, range.middle, range.end);
    kept[range.begin] =
        cluster(clusters, range.begin, left, range.middle, right, HPLOC_KEPT, nodes, cluster_nodes);
}

/// Merges the remaining clusters into the root. One work-item. There are at least two primitives.
__kernel void cluster_root(GLOBAL PrimitiveRef *clusters, GLOBAL const uint *kept, uint count,
                           GLOBAL BvhNode *nodes, GLOBAL ClusterNode *cluster_nodes,
                           GLOBAL ClusterState *state) {
    if (get_global_id(0) != 0) {
        return;
    }
    cluster(clusters, 0, kept_of(kept, 0, count), 0, 0, 1, nodes, cluster_nodes);
    const uint root = clusters[0].triangle;
    cluster_nodes[clusters[0].padding].count = 0;
    state->root = root;
    state->node_count = cluster_nodes[root].nodes;
    state->depth = cluster_nodes[root].height;
}
