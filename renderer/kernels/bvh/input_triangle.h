// SPDX-License-Identifier: MIT
// Input triangles of the builder, and the test whether they can be hit.
#pragma once

#include "renderer/kernels/bvh/build_records.h"
#include "renderer/kernels/geometry/surface_point.h"

/// Reasons for which a triangle cannot be hit.
typedef enum TriangleFault {
    TRIANGLE_GOOD,
    TRIANGLE_NOT_FINITE,
    TRIANGLE_DEGENERATE,
    TRIANGLE_BAD_INDEX
} TriangleFault;

DEVICE float3 load_vertex(GLOBAL const float *positions, uint index) {
    return make_float3(positions[3 * index], positions[3 * index + 1], positions[3 * index + 2]);
}

/// Sets `ref` to the box of an input triangle if it can be hit, and returns the reason otherwise.
DEVICE TriangleFault load_primitive(GLOBAL const float *positions, uint vertex_count,
                                    GLOBAL const uint *indices, uint triangle,
                                    PRIVATE PrimitiveRef *ref) {
    const uint i0 = indices[3 * triangle];
    const uint i1 = indices[3 * triangle + 1];
    const uint i2 = indices[3 * triangle + 2];
    if (max(i0, max(i1, i2)) >= vertex_count) {
        return TRIANGLE_BAD_INDEX;
    }
    const float3 v0 = load_vertex(positions, i0);
    const float3 v1 = load_vertex(positions, i1);
    const float3 v2 = load_vertex(positions, i2);
    // The comparisons are such that NaN fails.
    const float3 a = fabs(v0);
    const float3 b = fabs(v1);
    const float3 c = fabs(v2);
    const float limit = BVH_COORDINATE_LIMIT;
    if (!(a.x <= limit && a.y <= limit && a.z <= limit && b.x <= limit && b.y <= limit &&
          b.z <= limit && c.x <= limit && c.y <= limit && c.z <= limit)) {
        return TRIANGLE_NOT_FINITE;
    }
    const float3 normal = triangle_normal(v0, v1, v2);
    if (normal.x == 0.0f && normal.y == 0.0f && normal.z == 0.0f) {
        return TRIANGLE_DEGENERATE;
    }
    const float3 lower = min(v0, min(v1, v2));
    const float3 upper = max(v0, max(v1, v2));
    ref->lower[0] = lower.x;
    ref->lower[1] = lower.y;
    ref->lower[2] = lower.z;
    ref->upper[0] = upper.x;
    ref->upper[1] = upper.y;
    ref->upper[2] = upper.z;
    ref->triangle = triangle;
    ref->padding = 0;
    return TRIANGLE_GOOD;
}
