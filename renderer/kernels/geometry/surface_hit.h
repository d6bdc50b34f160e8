// SPDX-License-Identifier: MIT
// The hit of a path, on a triangle or a shape, with the data for shading.
#pragma once

#include "renderer/kernels/geometry/shape_point.h"
#include "renderer/kernels/geometry/surface.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/path_state.h"

/// A hit point with shading data. Normals are those of the front.
typedef struct SurfaceHit {
    SurfacePoint point;  ///< with the geometric normal
    float3 normal;       ///< for shading, unit
    float3 tangent;      ///< dp/du, of any length; zero if undefined or not needed
    /// Gradients of u and v along the surface; zero if undefined or not needed.
    float3 gradient_u, gradient_v;
    float2 uv;
    float3 colour;  ///< interpolated between vertices; white if there is none or it is not needed
    uint material;
    /// For a triangle the index of its emitter triangle, for a shape that of its light; or
    /// NO_EMITTER.
    uint emitter;
} SurfaceHit;

/// Returns a tangent of a triangle: its first edge, unless the (u, v) of its corners span the
/// plane. Then it is dp/du up to a positive factor: (dv2 e1 - dv1 e2) times the sign of the
/// Jacobian.
DEVICE float3 triangle_tangent(PRIVATE const SceneView *scene, uint triangle) {
    GLOBAL const SurfaceTriangle *surface = scene->surface_triangles + triangle;
    const float3 p0 = make_float3(surface->p0[0], surface->p0[1], surface->p0[2]);
    const float3 e1 = make_float3(surface->p1[0], surface->p1[1], surface->p1[2]) - p0;
    const float3 e2 = make_float3(surface->p2[0], surface->p2[1], surface->p2[2]) - p0;
    if (!FEATURE_texture_coordinates) {
        return e1;
    }
    GLOBAL const TriangleUv *at = scene->triangle_uvs + triangle;
    const float du1 = at->uv[1][0] - at->uv[0][0], dv1 = at->uv[1][1] - at->uv[0][1];
    const float du2 = at->uv[2][0] - at->uv[0][0], dv2 = at->uv[2][1] - at->uv[0][1];
    const float jacobian = du1 * dv2 - du2 * dv1;
    const float3 along = e1 * dv2 - e2 * dv1;
    return jacobian > 0.0f ? along : jacobian != 0.0f ? -along : e1;
}

/// Sets the gradients of u and v on a triangle with the unit normal `n`, if the (u, v) of its
/// corners span the plane.
DEVICE void triangle_gradients(PRIVATE const SceneView *scene, uint triangle, float3 n,
                               PRIVATE float3 *gradient_u, PRIVATE float3 *gradient_v) {
    GLOBAL const SurfaceTriangle *surface = scene->surface_triangles + triangle;
    const float3 p0 = make_float3(surface->p0[0], surface->p0[1], surface->p0[2]);
    const float3 e1 = make_float3(surface->p1[0], surface->p1[1], surface->p1[2]) - p0;
    const float3 e2 = make_float3(surface->p2[0], surface->p2[1], surface->p2[2]) - p0;
    const float twice_area = dot(cross(e1, e2), n);
    if (!FEATURE_texture_coordinates || !(twice_area > 0.0f)) {
        return;
    }
    GLOBAL const TriangleUv *at = scene->triangle_uvs + triangle;
    const float du1 = at->uv[1][0] - at->uv[0][0], dv1 = at->uv[1][1] - at->uv[0][1];
    const float du2 = at->uv[2][0] - at->uv[0][0], dv2 = at->uv[2][1] - at->uv[0][1];
    if (du1 * dv2 - du2 * dv1 == 0.0f) {
        return;
    }
    // Their products with e1 and e2 are the differences of u and v along these edges.
    *gradient_u = cross(e1 * (-du2 / twice_area) + e2 * (du1 / twice_area), n);
    *gradient_v = cross(e1 * (-dv2 / twice_area) + e2 * (dv1 / twice_area), n);
}

/// Returns the texture coordinates of a triangle at barycentrics (1 - u - v, u, v).
DEVICE float2 triangle_uv(PRIVATE const SceneView *scene, uint triangle, float u, float v) {
    GLOBAL const TriangleUv *at = scene->triangle_uvs + triangle;
    const float w = 1.0f - u - v;
    return make_float2(w * at->uv[0][0] + u * at->uv[1][0] + v * at->uv[2][0],
                       w * at->uv[0][1] + u * at->uv[1][1] + v * at->uv[2][1]);
}

/// Returns the colour of a triangle at barycentrics (1 - u - v, u, v). Rounding may make the first
/// one negative, but no channel of a colour.
DEVICE float3 triangle_colour(PRIVATE const SceneView *scene, uint triangle, float u, float v) {
    GLOBAL const TriangleColours *at = scene->triangle_colours + triangle;
    const float w = 1.0f - u - v;
    const float3 colour =
        make_float3(w * at->colour[0][0] + u * at->colour[1][0] + v * at->colour[2][0],
                    w * at->colour[0][1] + u * at->colour[1][1] + v * at->colour[2][1],
                    w * at->colour[0][2] + u * at->colour[1][2] + v * at->colour[2][2]);
    return max(colour, make_float3(0.0f, 0.0f, 0.0f));
}

/// Returns the hit with barycentrics (1 - u - v, u, v) on a triangle.
DEVICE SurfaceHit triangle_hit(PRIVATE const SceneView *scene, uint triangle, float u, float v) {
    GLOBAL const SurfaceTriangle *surface = scene->surface_triangles + triangle;
    SurfaceHit hit;
    hit.point = scene_point(surface, u, v);
    hit.normal = hit.point.normal;
    hit.tangent = make_float3(0.0f, 0.0f, 0.0f);
    hit.gradient_u = make_float3(0.0f, 0.0f, 0.0f);
    hit.gradient_v = make_float3(0.0f, 0.0f, 0.0f);
    hit.uv = make_float2(0.0f, 0.0f);
    hit.colour = make_float3(1.0f, 1.0f, 1.0f);
    hit.material = surface->material;
    hit.emitter = surface->emitter;
    const float w = 1.0f - u - v;
    if (FEATURE_smooth_normals && scene->triangle_normals[triangle].is_smooth != 0u) {
        GLOBAL const TriangleNormals *corners = scene->triangle_normals + triangle;
        const float3 n = make_float3(
            w * corners->normal[0][0] + u * corners->normal[1][0] + v * corners->normal[2][0],
            w * corners->normal[0][1] + u * corners->normal[1][1] + v * corners->normal[2][1],
            w * corners->normal[0][2] + u * corners->normal[1][2] + v * corners->normal[2][2]);
        // Opposite unit normals may cancel. The geometric normal then replaces their sum.
        const float squared = dot(n, n);
        hit.normal = squared > 1e-12f ? n / sqrt(squared) : hit.point.normal;
    }
    if (FEATURE_texture_coordinates) {
        hit.uv = triangle_uv(scene, triangle, u, v);
    }
    if (FEATURE_vertex_colours) {
        hit.colour = triangle_colour(scene, triangle, u, v);
    }
    if (FEATURE_tangents) {
        hit.tangent = triangle_tangent(scene, triangle);
    }
    if (FEATURE_normal_maps) {
        triangle_gradients(scene, triangle, hit.point.normal, &hit.gradient_u, &hit.gradient_v);
    }
    return hit;
}

/// Returns the hit at `object_point`, on the surface of a shape in object space.
DEVICE SurfaceHit shape_hit(GLOBAL const ShapeRecord *shape, float3 object_point) {
    SurfaceHit hit;
    hit.point = shape_point(shape, object_point);
    hit.normal = hit.point.normal;
    hit.tangent = make_float3(0.0f, 0.0f, 0.0f);
    hit.gradient_u = make_float3(0.0f, 0.0f, 0.0f);
    hit.gradient_v = make_float3(0.0f, 0.0f, 0.0f);
    hit.uv = make_float2(0.0f, 0.0f);
    hit.colour = make_float3(1.0f, 1.0f, 1.0f);
    if (FEATURE_textures) {
        hit.uv = shape_uv(shape, object_point);
    }
    if (FEATURE_tangents) {
        hit.tangent = shape_tangent(shape, object_point);
    }
    hit.material = shape->material;
    hit.emitter = shape->light;
    return hit;
}

/// Returns the hit of a path; `primitive` and `at` are those of the path state.
DEVICE SurfaceHit surface_hit(PRIVATE const SceneView *scene, uint primitive, float3 at) {
    if (FEATURE_shapes && (!FEATURE_triangles || (primitive & SHAPE_BIT) != 0u)) {
        return shape_hit(scene->shapes + (primitive & ~SHAPE_BIT), at);
    }
    return triangle_hit(scene, primitive, at.x, at.y);
}

#ifdef __OPENCL_VERSION__

/// Returns the barycentrics of a path's hit on a triangle, or its object-space point on a shape.
DEVICE float3 get_hit_at(Path path) {
    return make_float3(get_hit_u(path), get_hit_v(path), get_hit_w(path));
}

#endif
