// SPDX-License-Identifier: MIT
// The nearest hit of a ray, and the intersection test of one triangle (watertight.h).
#pragma once

#include "renderer/kernels/traversal/opacity.h"
#include "renderer/kernels/traversal/traversal_ray.h"
#include "renderer/shared/bvh_node.h"
#include "renderer/shared/hit_primitive.h"
#include "renderer/shared/triangle.h"

/// Programs that define this as 1 count traversal work (trace_rays.cl). In all other programs the
/// counting macros are empty.
#ifndef TRAVERSAL_COUNTS
#define TRAVERSAL_COUNTS 0
#endif

/// The nearest intersection of a ray. If nothing was hit, t is the query's t_max.
typedef struct Hit {
    float t;        ///< distance in lengths of the direction
    float u, v;     ///< weights of vertices 1 and 2; that of vertex 0 is 1 - u - v
    uint triangle;  ///< index in the scene's list of triangles; NO_HIT if nothing was hit
    uint slot;      ///< index in leaf order; NO_HIT if nothing was hit
#if TRAVERSAL_COUNTS
    uint nodes;      ///< number of nodes whose boxes were tested
    uint triangles;  ///< number of triangles tested, each of a block of several counted
#endif
} Hit;

#if TRAVERSAL_COUNTS
#define BEGIN_COUNTS(hit) ((hit).nodes = (hit).triangles = 0u)
#define COUNT(hit, what, number) ((hit).what += (number))
#else
#define BEGIN_COUNTS(hit)
#define COUNT(hit, what, number)
#endif

#ifdef __cplusplus
static_assert(sizeof(Hit) == 20, "as in OpenCL C");
#endif

/// Returns the hit before any test.
DEVICE Hit no_hit(float t_max) {
    Hit hit;
    hit.t = t_max;
    hit.u = 0.0f;
    hit.v = 0.0f;
    hit.triangle = NO_HIT;
    hit.slot = NO_HIT;
    BEGIN_COUNTS(hit);
    return hit;
}

#define REAL float
#define MASK int
#define OF_LANES(name) name
#include "renderer/kernels/traversal/watertight.h"
#undef REAL
#undef MASK
#undef OF_LANES

/// Returns whether the ray meets the triangle, from either side, at 0 < t < t_max. If so, sets t, u
/// and v of `hit`.
DEVICE bool intersect_triangle(GLOBAL const LeafTriangle *triangle, PRIVATE const TraversalRay *ray,
                               float t_max, PRIVATE Hit *hit) {
    GLOBAL const float *xs = triangle->coordinate[ray->kx];
    GLOBAL const float *ys = triangle->coordinate[ray->ky];
    GLOBAL const float *zs = triangle->coordinate[ray->kz];
    const EdgeFunctions edges =
        edge_functions(ray, xs[0], ys[0], zs[0], xs[1], ys[1], zs[1], xs[2], ys[2], zs[2]);
    if (!line_meets(&edges)) {
        return false;
    }
    float t, u, v;
    if (!meets_within(&edges, ray, t_max, &t, &u, &v)) {
        return false;
    }
    hit->t = t;
    hit->u = u;
    hit->v = v;
    return true;
}

/// Updates `hit` with the nearest hit at 0 < t < hit->t among the triangles of a leaf (bvh_node.h),
/// if there is one.
DEVICE void intersect_leaf(GLOBAL const LeafTriangle *triangles, uint link,
                           PRIVATE const TraversalRay *ray, PRIVATE const OpacityTest *opacity,
                           PRIVATE Hit *hit) {
    const uint first = bvh_leaf_first(link);
    const uint end = first + bvh_leaf_count(link);
    COUNT(*hit, triangles, end - first);
    for (uint slot = first; slot < end; ++slot) {
        Hit nearer = *hit;
        if (intersect_triangle(triangles + slot, ray, hit->t, &nearer) &&
            triangle_stops(opacity, triangles[slot].id, nearer.u, nearer.v)) {
            *hit = nearer;
            hit->slot = slot;
        }
    }
}
