// SPDX-License-Identifier: MIT
// Stages that order primitives along a space-filling curve.
//
// encode_centroids writes a Morton code for each primitive (G. M. Morton, 1966; J. Pantaleoni, D.
// Luebke, "HLBVH", HPG 2010), radix_sort.cl sorts the codes, and gather_clusters moves the
// primitives.
#include "renderer/kernels/bvh/hploc.h"

/// Number of bits of a coordinate. Cells are cubes of 2^-21 of the largest extent of the centroids.
#define MORTON_BITS 21u

/// Spreads the bits of x: bit i moves to bit 3 i.
static ulong spread_bits(uint x) {
    ulong bits = x;
    bits = (bits | bits << 32) & 0x001f00000000fffful;
    bits = (bits | bits << 16) & 0x001f0000ff0000fful;
    bits = (bits | bits << 8) & 0x100f00f00f00f00ful;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3ul;
    bits = (bits | bits << 2) & 0x1249249249249249ul;
    return bits;
}

/// Writes the codes of primitives. `all` is the single range of all primitives, with its bounds.
__kernel void encode_centroids(GLOBAL const PrimitiveRef *primitives, uint count,
                               GLOBAL const BuildSubtree *all, GLOBAL ulong *codes,
                               GLOBAL uint *order) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    GLOBAL const float(*bounds)[3] = all->bounds.centroids;
    float extent = 0.0f;
    for (uint axis = 0; axis < 3; ++axis) {
        extent = max(extent, bounds[1][axis] - bounds[0][axis]);
    }
    const float cells = (float)(1u << MORTON_BITS);
    // The threshold is far above the extent at which the quotient overflows.
    const float scale = extent > 1.0e-30f ? cells / extent : 0.0f;
    ulong code = 0;
    for (uint axis = 0; axis < 3; ++axis) {
        const float centroid = primitives[i].lower[axis] + primitives[i].upper[axis];
        const uint cell = (uint)min((centroid - bounds[0][axis]) * scale, cells - 1.0f);
        code |= spread_bits(cell) << axis;
    }
    codes[i] = code;
    order[i] = i;
}

/// Writes every primitive, in sorted order, as a cluster. `triangle` becomes its link, a leaf of
/// one triangle, and `padding` its location.
__kernel void gather_clusters(GLOBAL const PrimitiveRef *primitives, GLOBAL const uint *order,
                              uint count, GLOBAL PrimitiveRef *clusters) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    PrimitiveRef cluster = primitives[order[i]];
    cluster.triangle |= BVH_LEAF_BIT;
    cluster.padding = i;
    clusters[i] = cluster;
}
