// SPDX-License-Identifier: MIT
// Sampling of emission: the rays with which light paths leave the lights, and their densities
// (thesis, section 3.3.4; Veach 1997, section 8.2). The densities that MIS weights require for
// other strategies are in light.h.
//
// Surfaces emit from points uniform by area (with a texture, uniform on each triangle) into
// directions in proportion to the cosine. The weight is thus pi L over the density of the point.
// For light from infinity, the direction is sampled first. Then a point is sampled on a disc
// perpendicular to it, as wide as the sphere around the scene's bounded surfaces. The weight is pi
// R^2 L over the density of the direction.
//
// Such paths light only the part of a plane that is in the shadow of that sphere. The rest is left
// to other strategies (`disc_pdf_a`), and remains dark without them.
//
// A guide (emission_guide.h) selects the light in place of `selection_end`, and may multiply the
// density of its directions by g.
#pragma once

#include "renderer/kernels/light/light.h"
#include "renderer/kernels/math/circle.h"

/// The start of a light path.
typedef struct EmissionSample {
    /// On the light, with `normal` on the emitting side. For lights without a surface: the origin
    /// of the ray, with `normal` along its direction.
    SurfacePoint point;
    float3 origin;     ///< origin of the ray, off the light's own surface
    float3 direction;  ///< unit, away from the light
    /// Power of the path in W, L cos / (pdf_origin pdf_direction). For a surface: pi L /
    /// (pdf_origin g).
    float3 weight;
    /// p_o of MIS (4): density of the origin, with the selection probability. Surfaces: per area.
    /// Dome and environment: per solid angle of the direction. Point, spot and directional lights:
    /// the probability alone.
    float pdf_origin;
    /// p_d of MIS (4) in another measure: density of the direction. Surfaces, point and spot
    /// lights: per solid angle. Lights at infinity: per area of the disc.
    float pdf_direction;
    float guide;       ///< g, a factor of pdf_direction; 1 without a table
    uint light;        ///< index of the light
    float2 uv;         ///< texture coordinates of the point, if a light has a texture
    uint is_delta;     ///< point, spot and directional lights, which cannot be hit
    uint at_infinity;  ///< dome, environment and directional lights
} EmissionSample;

/// Samples a uniform point on the disc that rays of direction `d` (unit) from infinity cross before
/// they meet the scene.
DEVICE float3 sample_disc_origin(PRIVATE const SceneView *scene, float3 d, float u, float v) {
    const Frame frame = frame_from_z(d);
    const float2 disc = sample_disc(u, v);
    float3 origin = make_float3(scene->lighting.scene_centre[0], scene->lighting.scene_centre[1],
                                scene->lighting.scene_centre[2]) +
                    (frame.x * disc.x + frame.y * disc.y - d) * scene->lighting.scene_radius;
    // Planes extend beyond the sphere, so the ray starts before the first plane that it meets.
    // Planes beyond the length of shadow rays are ignored, as shadow rays ignore them.
    float back = 0.0f;
    for (uint i = 0; FEATURE_quadrics && i < scene->lighting.plane_end; ++i) {
        GLOBAL const ShapeRecord *shape = scene->shapes + i;
        if (shape->uv_kind == SHAPE_UV_PLANE) {
            const float distance = vector_to_object(shape, origin - shape_centre(shape)).z /
                                   vector_to_object(shape, d).z;
            back = distance < scene->lighting.far_distance ? max(back, distance) : back;
        }
    }
    // The ray moves back twice as far; otherwise rounding would decide on which side of the plane
    // it starts. No other surface is there.
    return FEATURE_quadrics ? origin - d * (2.0f * back) : origin;
}

/// Completes the start at a point on an area light. `cosine` is that of the direction, which is
/// set, as is g.
DEVICE void leave_surface(PRIVATE const SceneView *scene, LightRecord light, SurfacePoint point,
                          float2 uv, float pdf_a, float cosine, PRIVATE EmissionSample *sample) {
    sample->point = point;
    sample->uv = uv;
    sample->origin = offset_ray_origin(point, point.normal);
    sample->pdf_origin = light.emission_selection * pdf_a;
    sample->pdf_direction = cosine * INV_PI * sample->guide;
    // A triangle without area has no density, but no word selects it.
    sample->weight = surface_radiance(scene, light, uv) * (PI / sample->pdf_origin);
    sample->weight = sample->weight / sample->guide;
}

/// Emits from a point on an area light into the hemisphere of its normal, in proportion to the
/// cosine and to g.
DEVICE void emit_from_surface(PRIVATE const SceneView *scene, LightRecord light, SurfacePoint point,
                              float2 uv, float pdf_a, uint4 b, PRIVATE EmissionSample *sample) {
    const GuideSample square = sample_guide(scene, light, b.x, b.y);
    const float3 about_z = sample_cosine_hemisphere(square.u, square.v);
    Frame frame = frame_from_z(point.normal);
    if (has_guide_table(light)) {
        frame.x = make_float3(light.axis_x[0], light.axis_x[1], light.axis_x[2]);
        frame.y = make_float3(light.axis_y[0], light.axis_y[1], light.axis_y[2]);
        frame.z = light_axis_z(light);
    }
    sample->direction = to_world(frame, about_z);
    sample->guide = square.density;
    leave_surface(scene, light, point, uv, pdf_a, about_z.z, sample);
}

/// Emits from a sphere with a table: samples a direction, then the point where its ray leaves,
/// which is uniform on the silhouette.
DEVICE void emit_from_sphere(PRIVATE const SceneView *scene, LightRecord light, float u, float v,
                             uint4 b, PRIVATE EmissionSample *sample) {
    const GuideSample square = sample_guide(scene, light, b.x, b.y);
    const float3 about_z = sample_cosine_hemisphere(u, v);
    sample->direction = sample_uniform_sphere(square.u, square.v);
    sample->guide = square.density;
    const float3 normal = to_world(frame_from_z(sample->direction), about_z);
    GLOBAL const ShapeRecord *shape = scene->shapes + light.first_triangle;
    const ShapeLightSample on =
        shape_light_sample(shape, sphere_object_point(shape, normal), shape_centre(shape));
    leave_surface(scene, light, on.point, on.uv, 1.0f / light.area, about_z.z, sample);
}

/// Samples the start of a light path from a point or spot light from the last two words of `a`.
DEVICE void emit_from_position(PRIVATE const SceneView *scene, LightRecord light, uint4 a,
                               PRIVATE EmissionSample *sample) {
    sample->origin = make_float3(light.position[0], light.position[1], light.position[2]);
    sample->is_delta = 1u;
    if (FEATURE_spot_lights && (!FEATURE_point_lights || light.kind == LIGHT_SPOT)) {
        const SpotDirection spot = sample_spot(light, uniform_float(a.z));
        const float sine = sqrt(spot.versine * (2.0f - spot.versine));
        const float2 around = point_on_circle(uniform_float(a.w));
        sample->direction =
            make_float3(light.axis_x[0], light.axis_x[1], light.axis_x[2]) * (sine * around.x) +
            make_float3(light.axis_y[0], light.axis_y[1], light.axis_y[2]) * (sine * around.y) +
            light_axis_z(light) * (spot.versine - 1.0f);
        sample->pdf_direction = spot_pdf_w(light, spot);
        sample->weight *= spot_share(light, spot) / sample->pdf_direction;
    } else {
        const GuideSample square = sample_guide(scene, light, a.z, a.w);
        sample->direction = sample_uniform_sphere(square.u, square.v);
        sample->guide = square.density;
        sample->pdf_direction = 0.25f * INV_PI * square.density;
        sample->weight *= 4.0f * PI / square.density;
    }
}

/// Samples the start of a light path from a light at infinity from the words of `a` and the first
/// two of `b`.
DEVICE void emit_from_infinity(PRIVATE const SceneView *scene, LightRecord light, uint4 a, uint4 b,
                               PRIVATE EmissionSample *sample) {
    sample->at_infinity = 1u;
    if (FEATURE_directional_lights && light.kind == LIGHT_DIRECTIONAL) {
        sample->direction = -light_axis_z(light);
        sample->is_delta = 1u;
    } else if (is_environment(light)) {
        const EnvironmentSample towards =
            sample_environment(scene->environment_ends, scene->lighting, a);
        sample->direction = -from_light_space(light, towards.direction);
        sample->pdf_origin *= towards.pdf_w;
        sample->weight *=
            environment_radiance(scene->environment_texels, scene->lighting, towards.direction) /
            towards.pdf_w;
    } else {
        sample->direction = sample_uniform_sphere(uniform_float(a.z), uniform_float(a.w));
        sample->pdf_origin *= 0.25f * INV_PI;
        sample->weight *= 4.0f * PI;
    }
    sample->origin =
        sample_disc_origin(scene, sample->direction, uniform_float(b.x), uniform_float(b.y));
    sample->pdf_direction = disc_pdf_a_inside(scene->lighting);
    sample->weight = sample->weight / sample->pdf_direction;
}

/// Returns the light that a word selects for the start of a light path.
DEVICE uint select_emitter(PRIVATE const SceneView *scene, uint word) {
    if (!FEATURE_many_lights && !FEATURE_independent_lights) {
        return 0u;
    }
    if (is_guided(scene)) {
        SELECT_BY_WORD(scene->emission_guide, , 0u, scene->lighting.light_count, word, guided)
        return guided;
    }
    SELECT_BY_WORD(scene->lights, .selection_end, 0u, scene->lighting.light_count, word, selected)
    return selected;
}

/// Samples the start of a light path from light `index`, whose record is `light`, from the last
/// three words of `a` and the first two of `b`.
DEVICE EmissionSample emit_from_light(PRIVATE const SceneView *scene, uint index, LightRecord light,
                                      uint4 a, uint4 b) {
    EmissionSample sample;
    sample.light = index;
    const float u = uniform_float(a.z), v = uniform_float(a.w);
    const float3 none = make_float3(0.0f, 0.0f, 0.0f);
    sample.origin = none;
    sample.direction = none;
    sample.uv = make_float2(0.0f, 0.0f);
    sample.weight = light_radiance(light) / light.emission_selection;
    sample.pdf_origin = light.emission_selection;
    sample.pdf_direction = 0.0f;
    sample.guide = 1.0f;
    sample.is_delta = 0u;
    sample.at_infinity = 0u;
    if (FEATURE_area_lights && light.kind == LIGHT_MESH) {
        const LightPoint on = sample_mesh_light(scene, light, a);
        emit_from_surface(scene, light, on.point, on.uv, on.pdf_a, b, &sample);
        return sample;
    }
    if (FEATURE_shape_lights && is_shape_light(light)) {
        if (has_guide_table(light) && light.kind != LIGHT_DISC) {
            emit_from_sphere(scene, light, u, v, b, &sample);
            return sample;
        }
        LightRecord by_area = light;
        by_area.kind = light.kind == LIGHT_DISC ? LIGHT_DISC : LIGHT_SPHERE_BY_AREA;
        const ShapeLightSample on = sample_shape_light(
            by_area, scene->shapes, shape_centre(scene->shapes + light.first_triangle), u, v);
        emit_from_surface(scene, light, on.point, on.uv, on.pdf_a, b, &sample);
        return sample;
    }
    if ((FEATURE_point_lights || FEATURE_spot_lights) &&
        (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT)) {
        emit_from_position(scene, light, a, &sample);
    } else if (FEATURE_infinite_lights || FEATURE_directional_lights) {
        emit_from_infinity(scene, light, a, b, &sample);
    }
    sample.point.position = sample.origin;
    sample.point.normal = sample.direction;
    sample.point.error = none;
    return sample;
}

/// Samples the start of a light path from the words of `a` and the first two of `b`.
DEVICE EmissionSample sample_emission(PRIVATE const SceneView *scene, uint4 a, uint4 b) {
    const uint index = select_emitter(scene, a.x);
    return emit_from_light(scene, index, light_at(scene, index), a, b);
}

/// Samples the start of a light path that is connected to the camera. Its origin has the density of
/// `emission_pdf_a`, since no table guides it.
DEVICE EmissionSample sample_seen_emission(PRIVATE const SceneView *scene, uint4 a, uint4 b) {
    const uint index = select_emitter(scene, a.x);
    LightRecord light = light_at(scene, index);
    light.guide_table = NO_GUIDE_TABLE;
    return emit_from_light(scene, index, light, a, b);
}
