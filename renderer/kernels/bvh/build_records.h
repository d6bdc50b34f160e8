// SPDX-License-Identifier: MIT
// Records of the binned BVH builder, shared by its kernels and the host that schedules them
// (renderer/bvh/builder.cpp).
#pragma once

#include "renderer/shared/bvh_node.h"

/// Number of bins per axis (K of the thesis, section 3.1), and number of binned axes: 3, or 1 for
/// the axis with the largest extent of centroids. Experiments compile programs with other values
/// for comparison.
#ifndef BVH_BINS
#define BVH_BINS 16u
#endif
#ifndef BVH_BINNED_AXES
#define BVH_BINNED_AXES 3u
#endif

/// Maximum number of chunks of a task. Large tasks have longer chunks, because some stages process
/// the chunks of a task one by one.
#define BVH_CHUNKS_PER_TASK 1024u

/// Limit of coordinates; larger ones count as not finite. Sums of two and products of three
/// coordinates within the limit stay in the range of float.
#define BVH_COORDINATE_LIMIT 1.0e12f

#define BVH_NO_PARENT 0xffffffffu
#define BVH_SPLIT_BY_COUNT 3u

/// The box and index of one triangle. The builder moves these records of 32 bytes and reads them in
/// order.
typedef struct PrimitiveRef {
    float lower[3];
    uint triangle;
    float upper[3];
    uint padding;
} PrimitiveRef;

/// A box, and the box of the doubled centroids in it. A doubled centroid is lower + upper of a
/// primitive: it has no product and no rounding bias.
typedef struct RangeBounds {
    float box[2][3];  ///< [lower, upper][x, y, z]
    float centroids[2][3];
} RangeBounds;

/// The split of a range of primitives: by bin on an axis, or into equal halves if the axis is
/// BVH_SPLIT_BY_COUNT.
typedef struct Split {
    uint axis;
    uint last_left_bin;
    uint left_count;
} Split;

/// A node that many work-items split together.
typedef struct BuildTask {
    uint begin, end;  ///< range of its primitives
    uint depth;
    uint node;         ///< index among the top nodes
    uint first_chunk;  ///< first of its chunks in this level's list
    uint chunk_count;
    RangeBounds bounds;
    Split split;              ///< set by choose_splits
    RangeBounds children[2];  ///< bounds of the left and right child, set by merge_children
} BuildTask;

/// A part of a task's primitives, processed by one work-item.
typedef struct BuildChunk {
    uint task;
    uint begin, end;
    /// Bounds of the primitives that go left and right, set by partition_primitives.
    RangeBounds bounds[2];
} BuildChunk;

/// A range small enough for one work-item to finish.
typedef struct BuildSubtree {
    uint begin, end;
    uint depth;
    uint parent;  ///< top node whose child it is; BVH_NO_PARENT for the root
    uint side;
    uint buffer;  ///< which of the two primitive buffers holds the range
    RangeBounds bounds;
    // The next four are set by build_subtrees; cost is in units of (1 / scene extent)^2.
    uint node_count;
    uint leaf_count;
    uint deepest_leaf;
    float cost;
    uint node_offset;  ///< set by place_subtrees
    uint padding;
} BuildSubtree;

/// Counts of one chunk of the input, before there is a tree.
typedef struct InputChunk {
    RangeBounds bounds;  ///< bounds of the accepted triangles
    uint accepted;
    uint not_finite;
    uint degenerate;
    uint bad_index;
    uint accepted_before;
    uint padding;
} InputChunk;

/// Results that the host reads back.
typedef struct BuildState {
    uint primitive_count;
    uint not_finite;
    uint degenerate;
    uint bad_index;
    uint task_count;   ///< number of tasks of the next level
    uint chunk_count;  ///< number of chunks of the next level
    uint top_node_count;
    uint subtree_count;
    uint node_count;  ///< number of nodes of the full tree
    uint leaf_count;
    uint depth;            ///< number of edges from the root to the deepest leaf
    float inverse_extent;  ///< 1 / the largest side of the scene's box
    float cost;            ///< SAH cost with K_T = K_I = 1
    float root_area;       ///< half the area of the root's box, in scene extents squared
} BuildState;

/// Boxes and counts of the bins of one range.
typedef struct BinSet {
    /// [axis, or 0 for the widest][bin][lower x, y, z, 0, -upper x, y, z, 0].
    float box[BVH_BINNED_AXES][BVH_BINS][8];
    uint count[BVH_BINNED_AXES][BVH_BINS];
} BinSet;

#ifdef __cplusplus
static_assert(sizeof(PrimitiveRef) == 32 && sizeof(RangeBounds) == 48 && sizeof(Split) == 12,
              "as in OpenCL C");
static_assert(sizeof(BuildTask) == 180 && sizeof(BuildChunk) == 108 && sizeof(BuildSubtree) == 96,
              "as in OpenCL C");
static_assert(sizeof(InputChunk) == 72 && sizeof(BuildState) == 56 && sizeof(BinSet) == 1728,
              "as in OpenCL C");
#endif
