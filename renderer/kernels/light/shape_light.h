// SPDX-License-Identifier: MIT
// Diffuse area lights on discs and spheres: sampling of points, and densities.
//
// Discs are sampled uniformly by area under any affine map, which scales all areas by the same
// factor. Spheres are under a similarity. They are sampled uniformly by area, or uniformly in the
// cone of directions that they subtend (P. Shirley, C. Wang, K. Zimmerman, "Monte Carlo techniques
// for direct lighting calculations", ACM TOG 15(1), 1996). The cone's formulas use sin^2 / (1 +
// cos) for 1 - cos. They are free of cancellation, however small the sphere looks.
#pragma once

#include "renderer/kernels/geometry/shape_point.h"
#include "renderer/kernels/math/circle.h"
#include "renderer/kernels/sampling/hemisphere.h"
#include "renderer/shared/compat.h"
#include "renderer/shared/scene_records.h"

/// A point on an emitting shape, which emits on the side of its normal.
typedef struct ShapeLightSample {
    SurfacePoint point;
    float pdf_a;  ///< conditional density per area, given the light
    float2 uv;    ///< texture coordinates, if a light has a texture
} ShapeLightSample;

/// Returns whether a light is an emitting shape.
DEVICE bool is_shape_light(LightRecord light) {
    return light.kind >= LIGHT_DISC && light.kind <= LIGHT_SPHERE_BY_AREA;
}

/// Returns sin^2 of the half angle of the cone that a sphere subtends from a point. Returns 0 if
/// area is sampled instead: for other kinds of light, and from inside or within 1e-4 radii of the
/// surface, where the sphere subtends almost a hemisphere or more.
DEVICE float sphere_cone(LightRecord light, GLOBAL const ShapeRecord *sphere, float3 from) {
    const float3 from_centre = from - shape_centre(sphere);
    const float distance2 = dot(from_centre, from_centre);
    const float3 radius = vector_to_world(sphere, make_float3(1.0f, 0.0f, 0.0f));
    const float radius2 = dot(radius, radius);
    return light.kind == LIGHT_SPHERE && distance2 > 1.0002f * radius2 ? radius2 / distance2 : 0.0f;
}

/// Returns the density per area with which `sample_shape_light`, called for `from`, samples `point`
/// on the light's surface, given the light. It is zero beyond the sphere's horizon, which the cone
/// does not reach.
DEVICE float shape_light_pdf_a(LightRecord light, GLOBAL const ShapeRecord *shapes, float3 from,
                               SurfacePoint point) {
    if (light.kind == LIGHT_SPHERE) {
        const float sin2 = sphere_cone(light, shapes + light.first_triangle, from);
        if (sin2 > 0.0f) {
            const float3 to_receiver = from - point.position;
            const float projected = dot(point.normal, to_receiver);
            if (!(projected > 0.0f)) {
                return 0.0f;
            }
            const float distance2 = dot(to_receiver, to_receiver);
            // 1 / (2 pi (1 - cos)).
            const float pdf_w = 0.5f * INV_PI * (1.0f + sqrt(1.0f - sin2)) / sin2;
            return pdf_w * projected / (distance2 * sqrt(distance2));
        }
    }
    return 1.0f / light.area;
}

/// Returns the point of a sphere, in object space, with the given normal in world space.
DEVICE float3 sphere_object_point(GLOBAL const ShapeRecord *sphere, float3 normal) {
    const float3 scaled = vector_to_object(sphere, normal);
    // Its length is 1 / radius. Squares stay in range for radii in [1e-12, 1e12].
    return scaled / length(scaled);
}

/// Returns the sample, without its density, at a point in object space. `from` is the point for
/// which the light is sampled.
DEVICE ShapeLightSample shape_light_sample(GLOBAL const ShapeRecord *shape, float3 object_point,
                                           float3 from) {
    ShapeLightSample sample;
    sample.point = shape_point(shape, object_point);
    sample.pdf_a = 0.0f;
    sample.uv = FEATURE_emission_textures ? shape_uv(shape, object_point) : make_float2(0.0f, 0.0f);
    // A shadow ray is the rounded difference of its ends. Over the distance D its end is off by u D
    // per axis, and the t at which it meets the light is off by a few u. The offset of that end
    // must exceed both. Otherwise lights would block themselves from 100 radii on.
    const float3 distance = fabs(from - sample.point.position);
    const float rounding = 16.0f * HALF_ULP * max(distance.x, max(distance.y, distance.z));
    sample.point.error += make_float3(rounding, rounding, rounding);
    return sample;
}

/// Samples a point on a disc or a sphere from uniform u and v in [0, 1). A LIGHT_SPHERE is sampled
/// by its cone where possible.
///
/// In the cone, theta is the angle between the direction and the cone's axis. beta is the angle
/// between the direction and the sphere's normal where it enters. alpha = beta - theta is the angle
/// between normal and axis. With k = 1 - cos theta = u (1 - cos theta_max), sin^2 theta = k (2 - k)
/// and sin beta = sin theta / sin theta_max, it follows that sin^2 beta = u (2 - k) / (1 + cos
/// theta_max). As sin theta_max -> 0 this becomes the uniform point of the sphere's silhouette.
DEVICE ShapeLightSample sample_shape_light(LightRecord light, GLOBAL const ShapeRecord *shapes,
                                           float3 from, float u, float v) {
    GLOBAL const ShapeRecord *shape = shapes + light.first_triangle;
    float3 object_point;
    if (light.kind != LIGHT_DISC) {
        const float sin2 = sphere_cone(light, shape, from);
        float sin_alpha, cos_alpha;
        Frame frame = frame_from_z(make_float3(0.0f, 0.0f, 1.0f));
        if (sin2 > 0.0f) {
            const float cos_max = sqrt(1.0f - sin2);
            const float sin_max = sqrt(sin2);
            const float k = u * (sin2 / (1.0f + cos_max));
            const float sin2_beta = min(u * (2.0f - k) / (1.0f + cos_max), 1.0f);
            const float cos_beta = sqrt(1.0f - sin2_beta);
            sin_alpha = sqrt(sin2_beta) * (1.0f - k - cos_beta * sin_max);
            cos_alpha = cos_beta * (1.0f - k) + sin2_beta * sin_max;
            frame = frame_from_z(normalize(from - shape_centre(shape)));
        } else {
            cos_alpha = 1.0f - 2.0f * u;
            sin_alpha = 2.0f * sqrt(u * (1.0f - u));
        }
        const float2 around = point_on_circle(v);
        const float3 normal =
            to_world(frame, make_float3(sin_alpha * around.x, sin_alpha * around.y, cos_alpha));
        object_point = sphere_object_point(shape, normal);
    } else {
        const float2 on_disc = sample_disc(u, v);
        object_point = make_float3(on_disc.x, on_disc.y, 0.0f);
    }
    ShapeLightSample sample = shape_light_sample(shape, object_point, from);
    sample.pdf_a = shape_light_pdf_a(light, shapes, from, sample.point);
    return sample;
}
