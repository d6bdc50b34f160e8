// SPDX-License-Identifier: MIT
// Points on the triangles of a scene.
#pragma once

#include "renderer/kernels/geometry/surface_point.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// Returns the point with barycentrics (1 - u - v, u, v) on a scene triangle. Its front is the side
/// from which the vertices run counter-clockwise.
DEVICE SurfacePoint scene_point(GLOBAL const SurfaceTriangle *s, float u, float v) {
    return surface_point_of(make_float3(s->p0[0], s->p0[1], s->p0[2]),
                            make_float3(s->p1[0], s->p1[1], s->p1[2]),
                            make_float3(s->p2[0], s->p2[1], s->p2[2]),
                            make_float3(s->normal[0], s->normal[1], s->normal[2]), s->extent, u, v);
}
