// SPDX-License-Identifier: MIT
// Watertight ray-triangle intersection (S. Woop, C. Benthin, I. Wald, JCGT 2(1), 2013).
//
// Vertices are sheared to the ray's frame one by one, so neighbours agree on every shared vertex bit by bit;
// from there on the test is two-dimensional with edge functions of exact sign: a closed surface cannot be
// missed, neither at an edge nor at a vertex. (Plücker edge functions are antisymmetric too, but their
// rounded signs can disagree around a vertex.) Departure from the paper: edge functions are computed without
// cancellation error by fma(), instead of falling back on double precision where they vanish. That also keeps
// the weights, and so t, exact on slivers, which the paper's plain difference does not (a sliver of aspect
// 1e-4 hit itself from 1e-6 away).
#pragma once

#include "renderer/kernels/traversal/traversal_ray.h"
#include "renderer/shared/triangle.h"

/// The nearest intersection of a ray. Where nothing was hit, t is the query's t_max.
typedef struct Hit {
    float t;        ///< distance in lengths of the direction
    float u, v;     ///< weights of vertices 1 and 2; vertex 0 weighs 1 - u - v
    uint triangle;  ///< index in the scene's list of triangles, NO_HIT when nothing was hit
    uint slot;      ///< index in leaf order, NO_HIT when nothing was hit
} Hit;

#define NO_HIT 0xffffffffu

#ifdef __cplusplus
static_assert(sizeof(Hit) == 20, "as in OpenCL C");
#endif

/// ax * by - ay * bx to 1.5 ulp of the result, hence with the exact sign (Kahan's difference of products;
/// C.-P. Jeannerod, N. Louvet, J.-M. Muller, Math. Comp. 82, 2013), as long as no product underflows.
DEVICE float edge_function(float ax, float ay, float bx, float by) {
    const float q = ay * bx;
    const float error = fma(-ay, bx, q);  // q - ay * bx, exactly
    return fma(ax, by, -q) + error;
}

/// True when the ray meets the triangle, from either side, at 0 < t < t_max; then sets t, u and v of `hit`.
/// A triangle with a NaN or infinite coordinate is never hit, nor one that is a line or a point in the ray's
/// frame. The error of t, as a length, is at most about u E (9 / cos + 12), where u = 2^-24, E is the largest
/// distance from the origin to a vertex and cos that between its normal and the ray: the vertices' rounding
/// across the ray, 6 u E on two axes (traversal_ray.h), tilts or shifts the plane, and t itself is rounded. For
/// positions use the barycentrics (kernels/geometry/surface_point.h).
DEVICE bool intersect_triangle(GLOBAL const LeafTriangle *triangle, PRIVATE const TraversalRay *ray,
                               float t_max, PRIVATE Hit *hit) {
    GLOBAL const float *xs = triangle->coordinate[ray->kx];
    GLOBAL const float *ys = triangle->coordinate[ray->ky];
    GLOBAL const float *zs = triangle->coordinate[ray->kz];
    const float ox = ray->origin[ray->kx];
    const float oy = ray->origin[ray->ky];
    const float oz = ray->origin[ray->kz];
    const float az = zs[0] - oz;
    const float bz = zs[1] - oz;
    const float cz = zs[2] - oz;
    const float ax = (xs[0] - ox) - ray->sx * az;
    const float ay = (ys[0] - oy) - ray->sy * az;
    const float bx = (xs[1] - ox) - ray->sx * bz;
    const float by = (ys[1] - oy) - ray->sy * bz;
    const float cx = (xs[2] - ox) - ray->sx * cz;
    const float cy = (ys[2] - oy) - ray->sy * cz;
    const float a = edge_function(bx, by, cx, cy);
    const float b = edge_function(cx, cy, ax, ay);
    const float c = edge_function(ax, ay, bx, by);
    if ((a < 0.0f || b < 0.0f || c < 0.0f) && (a > 0.0f || b > 0.0f || c > 0.0f)) {
        return false;
    }
    // No cancellation from here on: a, b, c have one sign, so the weights are those of a convex combination.
    const float inverse_area = 1.0f / (a + b + c);
    const float u = b * inverse_area;
    const float v = c * inverse_area;
    const float t = ray->sz * (a * inverse_area * az + u * bz + v * cz);
    if (!(t > 0.0f && t < t_max)) {  // also when the area is 0 or anything was not finite
        return false;
    }
    hit->t = t;
    hit->u = u;
    hit->v = v;
    return true;
}
