// SPDX-License-Identifier: MIT
// Bounds of ranges of primitives. Minimum and maximum are exact and associative, so the bits do not
// depend on the order of reduction.
#pragma once

#include "renderer/kernels/bvh/build_records.h"

DEVICE RangeBounds empty_bounds(void) {
    RangeBounds bounds;
    for (uint axis = 0; axis < 3; ++axis) {
        bounds.box[0][axis] = INFINITY;
        bounds.box[1][axis] = -INFINITY;
        bounds.centroids[0][axis] = INFINITY;
        bounds.centroids[1][axis] = -INFINITY;
    }
    return bounds;
}

// Compares and selects instead of calling fmin: no value here is NaN, and fmin costs more.
DEVICE float lesser(float a, float b) {
    return b < a ? b : a;
}
DEVICE float greater(float a, float b) {
    return b > a ? b : a;
}

/// Returns the smaller of both, lane by lane. For boxes with negated upper bounds this is the box
/// that encloses both.
DEVICE float8 enclosing(float8 a, float8 b) {
    return b < a ? b : a;
}

CONSTANT float box_signs[8] = {1.0f, 1.0f, 1.0f, 0.0f, -1.0f, -1.0f, -1.0f, 0.0f};

/// Returns the box of a record, read in one load: lower x, y, z, 0, then negated upper x, y, z, 0.
/// Lanes of integers become 0 before any arithmetic. The index of a triangle, read as a float, is
/// subnormal, and processors multiply subnormals a hundred times more slowly.
DEVICE float8 signed_box(PRIVATE const PrimitiveRef *ref) {
    const float8 signs = vload8(0, box_signs);
    return (signs != splat_float8(0.0f) ? vload8(0, ref->lower) : signs) * signs;
}

/// RangeBounds during accumulation, in the lanes of signed_box.
typedef struct SignedBounds {
    float box[8];
    float centroids[8];
} SignedBounds;

DEVICE SignedBounds empty_signed_bounds(void) {
    SignedBounds bounds;
    vstore8(splat_float8(INFINITY), 0, bounds.box);
    vstore8(splat_float8(INFINITY), 0, bounds.centroids);
    return bounds;
}

DEVICE void extend_bounds(PRIVATE SignedBounds *bounds, PRIVATE const PrimitiveRef *ref) {
    const float8 box = signed_box(ref);
    const float8 centroid = box - swap_halves(box);  // lower + upper, and its negative
    vstore8(enclosing(vload8(0, bounds->box), box), 0, bounds->box);
    vstore8(enclosing(vload8(0, bounds->centroids), centroid), 0, bounds->centroids);
}

DEVICE RangeBounds range_bounds(PRIVATE const SignedBounds *bounds) {
    RangeBounds result;
    for (uint axis = 0; axis < 3; ++axis) {
        result.box[0][axis] = bounds->box[axis];
        result.box[1][axis] = -bounds->box[4u + axis];
        result.centroids[0][axis] = bounds->centroids[axis];
        result.centroids[1][axis] = -bounds->centroids[4u + axis];
    }
    return result;
}

DEVICE void merge_bounds(PRIVATE RangeBounds *bounds, GLOBAL const RangeBounds *other) {
    for (uint axis = 0; axis < 3; ++axis) {
        bounds->box[0][axis] = lesser(bounds->box[0][axis], other->box[0][axis]);
        bounds->box[1][axis] = greater(bounds->box[1][axis], other->box[1][axis]);
        bounds->centroids[0][axis] = lesser(bounds->centroids[0][axis], other->centroids[0][axis]);
        bounds->centroids[1][axis] = greater(bounds->centroids[1][axis], other->centroids[1][axis]);
    }
}

/// Returns 1 / the largest side of the box, or 1 for an empty box or a point. Areas are scaled by
/// it before they are computed, so that none overflows.
DEVICE float inverse_extent(PRIVATE const RangeBounds *bounds) {
    float extent = 0.0f;
    for (uint axis = 0; axis < 3; ++axis) {
        extent = greater(extent, bounds->box[1][axis] - bounds->box[0][axis]);
    }
    return extent > 1.0e-30f ? 1.0f / extent : 1.0f;
}

/// Returns half the area of a box with sides scaled by `scale`; 0 for an empty box.
DEVICE float half_area(float dx, float dy, float dz, float scale) {
    const float x = dx * scale;
    const float y = dy * scale;
    const float z = dz * scale;
    return x >= 0.0f ? x * y + y * z + z * x : 0.0f;
}

/// Returns half the area of a range's box, with sides scaled by `scale`.
DEVICE float half_area_of(PRIVATE const RangeBounds *bounds, float scale) {
    return half_area(bounds->box[1][0] - bounds->box[0][0], bounds->box[1][1] - bounds->box[0][1],
                     bounds->box[1][2] - bounds->box[0][2], scale);
}

/// Writes child `side` of a node: the box and size of its range, and its link (bvh_node.h).
DEVICE void write_child(GLOBAL BvhNode *node, uint side, PRIVATE const RangeBounds *bounds,
                        uint count, uint link) {
    for (uint axis = 0; axis < 3; ++axis) {
        node->bounds[side][0][axis] = bounds->box[0][axis];
        node->bounds[side][1][axis] = bounds->box[1][axis];
    }
    node->child[side] = link;
    node->count[side] = count;
}
