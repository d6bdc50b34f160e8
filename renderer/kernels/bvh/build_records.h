// SPDX-License-Identifier: MIT
// Records of the BVH builder, shared by its kernels and the host that schedules them
// (renderer/bvh/builder.cpp).
#pragma once

#include "renderer/shared/bvh_node.h"

/// Bins on an axis (K of the thesis, 3.1), and how many axes are binned: all three, or 1, the one
/// along which the centroids lie widest. Programs are compiled for others to be compared with
/// these.
#ifndef BVH_BINS
#define BVH_BINS 16u
#endif
#ifndef BVH_BINNED_AXES
#define BVH_BINNED_AXES 3u
#endif

/// Chunks of a task at most: those of large tasks are longer, for some stages go through all chunks
/// of a task one by one.
#define BVH_CHUNKS_PER_TASK 1024u

/// Coordinates beyond this count as not finite: sums of two and products of three of them stay in
/// float's range.
#define BVH_COORDINATE_LIMIT 1.0e12f

#define BVH_NO_PARENT 0xffffffffu
#define BVH_SPLIT_BY_COUNT 3u

/// The box of one triangle, and which. These records are what the builder moves: 32 bytes, read in
/// order.
typedef struct PrimitiveRef {
    float lower[3];
    uint triangle;
    float upper[3];
    uint padding;
} PrimitiveRef;

/// A box, and the box of twice the centroids in it (lower + upper of each primitive: no product, no
/// rounding bias).
typedef struct RangeBounds {
    float box[2][3];  ///< [lower, upper][x, y, z]
    float centroids[2][3];
} RangeBounds;

/// How a range of primitives is split: by bin on an axis, or, with axis BVH_SPLIT_BY_COUNT, into
/// equal halves.
typedef struct Split {
    uint axis;
    uint last_left_bin;
    uint left_count;
} Split;

/// A node that is being split by many work-items.
typedef struct BuildTask {
    uint begin, end;  ///< its primitives
    uint depth;
    uint node;         ///< index among the top nodes
    uint first_chunk;  ///< its chunks in this level's list
    uint chunk_count;
    RangeBounds bounds;
    Split split;              ///< set by choose_splits
    RangeBounds children[2];  ///< of what goes left and right, set by merge_children
} BuildTask;

/// A piece of a task's primitives, the work of one work-item.
typedef struct BuildChunk {
    uint task;
    uint begin, end;
    RangeBounds
        bounds[2];  ///< of what this chunk sends left and right (set by partition_primitives)
} BuildChunk;

/// A range small enough for one work-item to finish.
typedef struct BuildSubtree {
    uint begin, end;
    uint depth;
    uint parent;  ///< top node whose child it is, BVH_NO_PARENT for the root
    uint side;
    uint buffer;  ///< which of the two primitive buffers holds the range
    RangeBounds bounds;
    // set by build_subtrees; cost is in units of (1 / scene extent)^2
    uint node_count;
    uint leaf_count;
    uint deepest_leaf;
    float cost;
    uint node_offset;  ///< set by place_subtrees
    uint padding;
} BuildSubtree;

/// Counts per chunk of the input, before any tree exists.
typedef struct InputChunk {
    RangeBounds bounds;  ///< of what it accepts
    uint accepted;
    uint not_finite;
    uint degenerate;
    uint bad_index;
    uint accepted_before;
    uint padding;
} InputChunk;

/// What the host reads back.
typedef struct BuildState {
    uint primitive_count;
    uint not_finite;
    uint degenerate;
    uint bad_index;
    uint task_count;   ///< of the coming level
    uint chunk_count;  ///< of the coming level
    uint top_node_count;
    uint subtree_count;
    uint node_count;  ///< of the whole tree
    uint leaf_count;
    uint depth;            ///< edges from the root to the deepest leaf
    float inverse_extent;  ///< 1 / the largest side of the scene's box
    float cost;            ///< SAH cost, K_T = K_I = 1
    float root_area;       ///< half the area of the root's box, in scene extents squared
} BuildState;

/// Boxes and counts of the bins of one range.
typedef struct BinSet {
    float box[BVH_BINNED_AXES][BVH_BINS][8];  ///< [axis, or 0 for the widest][bin][lower x, y, z,
                                              ///< 0, upper x, y, z with the sign changed, 0]
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
