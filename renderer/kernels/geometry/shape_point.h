// SPDX-License-Identifier: MIT
// The point of a shape that a ray hit: position, front-side normal, error, texture coordinates and
// tangent.
//
// The error bound ensures that a ray that leaves by offset_ray_origin starts on the intended side,
// as the next test of the same shape sees it. Let u, gamma, M and A be those of shape_space.h. Let
// p be the hit in object space, c the centre, q the quadric, g its gradient at p, and n = A^T g /
// |A^T g| the world normal.
//
// offset_ray_origin starts the ray at O = P + h n or beyond, where P = fl(M p + c), |P - (M p + c)|
// <= gamma(4) (|M| |p| + |c|), and h = |n|.error. The next test sees o = fl(A fl(O - c)). This adds
// errors of u |M| |p| in world space and gamma(4) |A| |M| |p| in object space. The test evaluates q
// there to within e = gamma(5) of the sum of its terms' magnitudes. To first order, the value that
// it sees is thus
//
//   q(o) >= |A^T g| (h - gamma(5) |n|.(|M| |p| + |c|)) - gamma(4) |g|.(|A| |M| |p|) - |q(p)| - e
//
// With error = gamma(5) (|M| |p| + |c|) + h3 it has the sign of the side if
//
//   h3 |A^T g| > |q(p)| + e + gamma(4) |g|.(|A| |M| |p|)
//
// h3 is chosen so that its left side is 2 (|q(p)| + e) + 36 u |g|.(|A| |M| |p|). The margin covers
// two more errors:
// - Second order: the displacement in object space is A n h, and a concave side loses up to |A n|^2
//   h^2. Near the rim of a flattened ellipsoid |A n| h reaches half the ratio of its axes times h3
//   |A^T g|; the margin covers ratios up to about 100. Beyond that, float world coordinates cannot
//   resolve the rim. Nor can they resolve the apex of a cone within a few h.
// - Directions: the sign of n.d in world space decides whether a ray leaves. The slope g.(A d) that
//   the next test sees may differ from it by gamma(12) |g|.(|A| |d|). That takes the ray back by at
//   most 24 u |g|.(|A| |M| |p|) over a distance of 2 |p|, so it does not hit rulings of cylinders
//   and cones again before that. Disc and plane pass through the object's origin; for them |x| + 1
//   and |y| + 1 replace |x| and |y|.
//
// On a convex surface seen from outside, B < 0 is such a rounding error. B^2 is then of order u^2
// and A C of order u, so the discriminant B^2 - A C is negative.
#pragma once

#include "renderer/kernels/geometry/julia.h"
#include "renderer/kernels/geometry/quadric.h"
#include "renderer/kernels/geometry/shape_space.h"
#include "renderer/kernels/geometry/surface_point.h"

/// Returns the point of a hit. `object_point` is that of ShapeHit, or any point within a few ulps
/// of the surface.
DEVICE SurfacePoint shape_point(GLOBAL const ShapeRecord *shape, float3 object_point) {
    // Gradient in object space, and bound |q(p)| + e of the deviation from 0 of the function that
    // vanishes on the surface.
    float3 g;
    float residual;
    if (is_julia(shape)) {
        g = julia_gradient(shape, object_point, &residual);
    } else {
        g = quadric_half_gradient(shape, object_point) * 2.0f;
        residual = fabs(quadric_value(shape, object_point)) +
                   6.0f * HALF_ULP * quadric_magnitude(shape, object_point);
    }
    const float steepness = fabs(g.x) + fabs(g.y) + fabs(g.z);
    if (steepness > 1e-30f) {
        g = g / steepness;
        residual = residual / steepness;
    } else {
        g = make_float3(0.0f, 0.0f, 1.0f);  // the apex of a cone
    }
    SurfacePoint point;
    const float3 centre = shape_centre(shape);
    point.position = vector_to_world(shape, object_point) + centre;

    const float3 world_gradient = gradient_to_world(shape, g);
    const float size = fabs(world_gradient.x) + fabs(world_gradient.y) + fabs(world_gradient.z);
    const float3 scaled = world_gradient / size;  // squares neither overflow nor underflow
    const float scaled_length = length(scaled);
    point.normal = scaled / scaled_length;

    // Flat shapes have p.z = 0, whether 1 is added or not.
    const float3 magnitude = shape->uv_kind == SHAPE_UV_DISC || shape->uv_kind == SHAPE_UV_PLANE
                                 ? fabs(object_point) + make_float3(1.0f, 1.0f, 0.0f)
                                 : fabs(object_point);
    const float3 world_magnitude = magnitude_to_world(shape, magnitude);
    const float rounding = dot(fabs(g), magnitude_to_object(shape, world_magnitude));
    const float normal_error =
        (2.0f * residual + 36.0f * HALF_ULP * rounding) / (size * scaled_length);
    point.error = (world_magnitude + fabs(centre)) * (6.0f * HALF_ULP) +
                  make_float3(normal_error, normal_error, normal_error);
    return point;
}

/// Returns (u, v) as ShapeArrays defines them. The angle about the z axis is in [0, 1) turns.
DEVICE float2 shape_uv(GLOBAL const ShapeRecord *shape, float3 object_point) {
    const float3 p = object_point;
    if (shape->uv_kind == SHAPE_UV_DISC) {
        return make_float2(0.5f * (p.x + 1.0f), 0.5f * (p.y + 1.0f));
    }
    if (shape->uv_kind == SHAPE_UV_PLANE) {
        return make_float2(p.x, p.y);
    }
    if (shape->uv_kind == SHAPE_UV_NONE) {
        return make_float2(0.0f, 0.0f);
    }
    const float turn = 0.5f * INV_PI * atan2(p.y, p.x);
    const float u = turn < 0.0f ? min(turn + 1.0f, 1.0f - HALF_ULP) : turn;
    if (shape->uv_kind == SHAPE_UV_SPHERE) {
        // The quotient is acos(z) / pi, and exact near the poles as well.
        return make_float2(u, 1.0f - INV_PI * atan2(sqrt(p.x * p.x + p.y * p.y), p.z));
    }
    const float v = shape->uv_kind == SHAPE_UV_HEIGHT  ? p.z
                    : shape->uv_kind == SHAPE_UV_DEPTH ? p.z + 1.0f
                                                       : 0.5f * (p.z + 1.0f);
    // The apex of a paraboloid may be below 0 by a rounding error.
    return make_float2(u, max(v, 0.0f));
}

/// Returns dp/du in world space, along the surface where u grows. It is zero on the axis and on a
/// Julia set.
DEVICE float3 shape_tangent(GLOBAL const ShapeRecord *shape, float3 object_point) {
    float3 tangent = make_float3(-2.0f * PI * object_point.y, 2.0f * PI * object_point.x, 0.0f);
    if (shape->uv_kind == SHAPE_UV_DISC) {
        tangent = make_float3(2.0f, 0.0f, 0.0f);
    } else if (shape->uv_kind == SHAPE_UV_PLANE) {
        tangent = make_float3(1.0f, 0.0f, 0.0f);
    } else if (shape->uv_kind == SHAPE_UV_NONE) {
        tangent = make_float3(0.0f, 0.0f, 0.0f);
    }
    return vector_to_world(shape, tangent);
}
