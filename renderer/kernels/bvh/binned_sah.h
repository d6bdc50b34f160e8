// SPDX-License-Identifier: MIT
// Binned surface area heuristic, over centroid bounds, with K = BVH_BINS bins on each of the three
// axes.
//
// Source: I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007; thesis,
// section 3.1, equation (3.4). The cost of a split is A_left N_left + A_right N_right. Leaves are
// made by count alone, so the constants of (3.4) do not matter.
#pragma once

#include "renderer/kernels/bvh/range_bounds.h"

/// Mapping of doubled centroids to bins: bin = (c - lower) * scale. The scale is 0 if an axis
/// cannot be split.
typedef struct Binning {
    float lower[3];
    float scale[3];
#if BVH_BINNED_AXES == 1u
    uint widest;
#endif
} Binning;

#if BVH_BINNED_AXES == 1u
/// The axis of an index in a BinSet, and the index of an axis.
#define BINNED_AXIS(binning, place) ((binning)->widest)
#define PLACE_OF_AXIS(axis) 0u
#else
#define BINNED_AXIS(binning, place) (place)
#define PLACE_OF_AXIS(axis) (axis)
#endif

/// Returns the mapping of centroids within `bounds` to bins.
DEVICE Binning make_binning(PRIVATE const RangeBounds *bounds) {
    Binning binning;
    for (uint axis = 0; axis < 3; ++axis) {
        const float extent = bounds->centroids[1][axis] - bounds->centroids[0][axis];
        binning.lower[axis] = bounds->centroids[0][axis];
        // The threshold is far above the extent at which 16 / extent overflows.
        binning.scale[axis] = extent > 1.0e-30f ? (float)BVH_BINS / extent : 0.0f;
    }
#if BVH_BINNED_AXES == 1u
    float widest = -1.0f;
    for (uint axis = 0; axis < 3; ++axis) {
        const float extent = bounds->centroids[1][axis] - bounds->centroids[0][axis];
        if (extent > widest) {
            widest = extent;
            binning.widest = axis;
        }
    }
#endif
    return binning;
}

/// Returns the bin of a primitive with bounds [lower, upper] on an axis.
DEVICE uint bin_index(PRIVATE const Binning *binning, uint axis, float lower, float upper) {
    const int bin = (int)((lower + upper - binning->lower[axis]) * binning->scale[axis]);
    return bin < (int)BVH_BINS ? (uint)bin : BVH_BINS - 1u;
}

DEVICE void clear_bins(PRIVATE BinSet *bins) {
    for (uint place = 0; place < BVH_BINNED_AXES; ++place) {
        for (uint bin = 0; bin < BVH_BINS; ++bin) {
            vstore8(splat_float8(INFINITY), 0, bins->box[place][bin]);
            bins->count[place][bin] = 0;
        }
    }
}

DEVICE void add_to_bins(PRIVATE BinSet *bins, PRIVATE const Binning *binning,
                        PRIVATE const PrimitiveRef *ref) {
    const float8 box = signed_box(ref);
    for (uint place = 0; place < BVH_BINNED_AXES; ++place) {
        const uint axis = BINNED_AXIS(binning, place);
        const uint bin = bin_index(binning, axis, ref->lower[axis], ref->upper[axis]);
        PRIVATE float *bin_box = bins->box[place][bin];
        vstore8(enclosing(vload8(0, bin_box), box), 0, bin_box);
        bins->count[place][bin] += 1u;
    }
}

/// Returns half the area of a box of a BinSet.
DEVICE float half_area_of_bins(float8 box, float scale) {
    float b[8];
    vstore8(box, 0, b);
    return half_area(-b[4] - b[0], -b[5] - b[1], -b[6] - b[2], scale);
}

/// Returns the best split of `count` primitives. Ties go to the lower axis, then to the lower bin.
/// Splits by count, in the present order, at depths from BVH_AREA_DEPTH on (bvh_node.h), and if no
/// axis can be split because all centroids are equal.
DEVICE Split choose_split(PRIVATE const BinSet *bins, PRIVATE const Binning *binning, uint count,
                          uint depth, float scale) {
    Split best;
    best.axis = BVH_SPLIT_BY_COUNT;
    best.last_left_bin = 0;
    best.left_count = count / 2u;
    if (depth >= BVH_AREA_DEPTH) {
        return best;
    }
    float best_cost = INFINITY;
    for (uint place = 0; place < BVH_BINNED_AXES; ++place) {
        const uint axis = BINNED_AXIS(binning, place);
        if (binning->scale[axis] == 0.0f) {
            continue;
        }
        float right_cost[BVH_BINS];  // cost of the bins from this one on
        float8 box = splat_float8(INFINITY);
        uint right_count = 0;
        for (uint bin = BVH_BINS - 1u; bin > 0; --bin) {
            box = enclosing(box, vload8(0, bins->box[place][bin]));
            right_count += bins->count[place][bin];
            right_cost[bin] = (float)right_count * half_area_of_bins(box, scale);
        }
        box = splat_float8(INFINITY);
        uint left_count = 0;
        for (uint bin = 0; bin + 1u < BVH_BINS; ++bin) {
            box = enclosing(box, vload8(0, bins->box[place][bin]));
            left_count += bins->count[place][bin];
            const float cost =
                (float)left_count * half_area_of_bins(box, scale) + right_cost[bin + 1u];
            if (left_count > 0 && left_count < count && cost < best_cost) {
                best_cost = cost;
                best.axis = axis;
                best.last_left_bin = bin;
                best.left_count = left_count;
            }
        }
    }
    return best;
}

/// Returns whether a primitive goes left; `rank` is its position in the range. Both users of a
/// split call this predicate.
DEVICE bool goes_left(PRIVATE const Split *split, PRIVATE const Binning *binning,
                      PRIVATE const PrimitiveRef *ref, uint rank) {
    if (split->axis == BVH_SPLIT_BY_COUNT) {
        return rank < split->left_count;
    }
    return bin_index(binning, split->axis, ref->lower[split->axis], ref->upper[split->axis]) <=
           split->last_left_bin;
}
