// SPDX-License-Identifier: MIT
// Light sampling at a point (explicit paths), and the emission that implicit paths hit. Both use
// the same densities.
#pragma once

#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/light/area_light.h"
#include "renderer/kernels/light/emission_guide.h"
#include "renderer/kernels/light/environment.h"
#include "renderer/kernels/light/shape_light.h"
#include "renderer/kernels/light/spot.h"
#include "renderer/kernels/sampling/select.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/texture/texture.h"
#include "renderer/shared/scene_records.h"

/// A sampled direction towards a light.
typedef struct LightSample {
    float3 wi;      ///< unit, from the receiving point
    float3 target;  ///< end of the shadow ray, off the light's own surface
    /// W / (sr m^2) if nothing blocks it; for a delta light W / m^2 on a surface facing it.
    float3 radiance;
    /// Density per solid angle at the receiving point, with the selection probability; for a delta
    /// light the probability alone. 0: no light is received.
    float pdf_w;
    uint is_delta;  ///< point, spot and directional lights, which cannot be hit
    // Densities of a light path along the same ray (EmissionSample), set with
    // FEATURE_light_strategy.
    /// Density of this sample's origin over that of a light path's origin: p_oe / p_o of MIS (12).
    float sampling_over_emission;
    /// Density with which light paths arrive here, per area perpendicular to the ray; for lights at
    /// infinity 0 outside the disc. Times the cosine here, it is E of MIS (12), given x_k.
    float arrival_pdf_a;
} LightSample;

DEVICE float3 light_radiance(LightRecord light) {
    return make_float3(light.radiance[0], light.radiance[1], light.radiance[2]);
}

/// Returns the radiance that leaves an area light at texture coordinates `uv`.
DEVICE float3 surface_radiance(PRIVATE const SceneView *scene, LightRecord light, float2 uv) {
    float3 radiance = light_radiance(light);
    if (FEATURE_emission_textures && light.texture != NO_TEXTURE) {
        radiance *= texture_lookup(scene->textures + light.texture, scene->texels, uv);
    }
    return radiance;
}

DEVICE float3 light_axis_z(LightRecord light) {
    return make_float3(light.axis_z[0], light.axis_z[1], light.axis_z[2]);
}

/// Returns d^2 / cos, by which densities per area are multiplied to give densities per solid angle
/// (Veach 1997, equation 8.10). `to_point` leads to a point with normal `normal`. Returns 0 from
/// behind, and if both points coincide.
DEVICE float solid_angle_per_area(float3 to_point, float3 normal) {
    const float squared = dot(to_point, to_point);
    const float projected = -dot(normal, to_point);  // cosine times distance
    return projected > 0.0f ? squared * (sqrt(squared) / projected) : 0.0f;
}

/// Returns the density per area of the origins of light paths from infinity, on the disc as wide as
/// the sphere around the scene's bounded surfaces.
DEVICE float disc_pdf_a_inside(LightingRecord lighting) {
    return INV_PI / (lighting.scene_radius * lighting.scene_radius);
}

/// Returns the density per area of the origin of the light path from infinity that arrives at
/// `point` from direction d (unit). It is 0 on the parts of planes outside the disc.
DEVICE float disc_pdf_a(LightingRecord lighting, float3 point, float3 d) {
    const float3 from_centre =
        point -
        make_float3(lighting.scene_centre[0], lighting.scene_centre[1], lighting.scene_centre[2]);
    const float3 across = from_centre - d * dot(from_centre, d);
    // The radius has a margin for bounded surfaces that exceeds all rounding errors here.
    return dot(across, across) < lighting.scene_radius * lighting.scene_radius
               ? disc_pdf_a_inside(lighting)
               : 0.0f;
}

/// Transforms a direction to light space; from_light_space is the inverse.
DEVICE float3 to_light_space(LightRecord light, float3 d) {
    return make_float3(light.axis_x[0] * d.x + light.axis_x[1] * d.y + light.axis_x[2] * d.z,
                       light.axis_y[0] * d.x + light.axis_y[1] * d.y + light.axis_y[2] * d.z,
                       light.axis_z[0] * d.x + light.axis_z[1] * d.y + light.axis_z[2] * d.z);
}
DEVICE float3 from_light_space(LightRecord light, float3 d) {
    return make_float3(light.axis_x[0] * d.x + light.axis_y[0] * d.y + light.axis_z[0] * d.z,
                       light.axis_x[1] * d.x + light.axis_y[1] * d.y + light.axis_z[1] * d.z,
                       light.axis_x[2] * d.x + light.axis_y[2] * d.y + light.axis_z[2] * d.z);
}

/// Returns whether the light at infinity is an image, not a dome.
DEVICE bool is_environment(LightRecord light) {
    return FEATURE_environment && (!FEATURE_dome || light.kind == LIGHT_ENVIRONMENT);
}

/// Returns the radiance that a path meets if it leaves the scene in direction d.
DEVICE float3 infinite_radiance(PRIVATE const SceneView *scene, float3 d) {
    const LightRecord light = scene->lights[scene->lighting.infinite_light];
    if (is_environment(light)) {
        return light_radiance(light) * environment_radiance(scene->environment_texels,
                                                            scene->lighting,
                                                            to_light_space(light, d));
    }
    return light_radiance(light);
}

/// Returns the density per solid angle with which light sampling samples direction d, without the
/// selection probability.
DEVICE float infinite_pdf_w(PRIVATE const SceneView *scene, float3 d) {
    const LightRecord light = scene->lights[scene->lighting.infinite_light];
    if (is_environment(light)) {
        return environment_pdf_w(scene->environment_ends, scene->lighting,
                                 to_light_space(light, d));
    }
    return 0.25f * INV_PI;
}

/// Turns a point on an area light into a light sample. `pdf_a` and `uniform_pdf_a` are the
/// densities per area of light sampling and of emission, both given the light.
DEVICE void look_at_point(float3 from, SurfacePoint point, float3 radiance, float pdf_a,
                          float uniform_pdf_a, PRIVATE LightSample *sample) {
    const float3 to_point = point.position - from;
    // From behind the density is 0. It is computed without a division by the distance, which may be
    // 0.
    sample->pdf_w = pdf_a * solid_angle_per_area(to_point, point.normal);
    sample->wi = to_point / sqrt(dot(to_point, to_point));
    sample->target = offset_ray_origin(point, -to_point);
    sample->radiance = radiance;
    sample->is_delta = 0u;
    if (FEATURE_light_strategy) {
        sample->sampling_over_emission *= pdf_a / uniform_pdf_a;
        sample->arrival_pdf_a =
            max(-dot(point.normal, sample->wi), 0.0f) * INV_PI / dot(to_point, to_point);
    }
}

/// Turns the position of a point or spot light into a light sample.
DEVICE void look_at_position(float3 from, LightRecord light, PRIVATE LightSample *sample) {
    sample->target = make_float3(light.position[0], light.position[1], light.position[2]);
    const float3 to_light = sample->target - from;
    const float squared = dot(to_light, to_light);
    float intensity = squared > 0.0f ? 1.0f / squared : 0.0f;
    sample->wi = to_light / sqrt(squared);
    if (FEATURE_light_strategy) {
        sample->arrival_pdf_a = 0.25f * INV_PI / squared;
    }
    if (FEATURE_spot_lights && light.kind == LIGHT_SPOT) {
        const SpotDirection spot = spot_direction(light, -sample->wi);
        // At the position of the light wi is NaN.
        intensity *= intensity > 0.0f ? spot_share(light, spot) : 0.0f;
        if (FEATURE_light_strategy) {
            sample->arrival_pdf_a = spot_pdf_w(light, spot) / squared;
        }
    }
    sample->radiance = light_radiance(light) * intensity;
    sample->is_delta = 1u;
    sample->pdf_w = intensity > 0.0f ? 1.0f : 0.0f;
}

/// Turns a light at infinity into a light sample.
DEVICE void look_at_infinity(PRIVATE const SceneView *scene, float3 from, LightRecord light,
                             uint4 words, PRIVATE LightSample *sample) {
    sample->radiance = light_radiance(light);
    if (FEATURE_directional_lights && light.kind == LIGHT_DIRECTIONAL) {
        sample->wi = light_axis_z(light);
        sample->is_delta = 1u;
        sample->pdf_w = 1.0f;
    } else if (is_environment(light)) {
        const EnvironmentSample towards =
            sample_environment(scene->environment_ends, scene->lighting, words);
        sample->wi = from_light_space(light, towards.direction);
        sample->radiance *=
            environment_radiance(scene->environment_texels, scene->lighting, towards.direction);
        sample->pdf_w = towards.pdf_w;
    } else {
        sample->wi = sample_uniform_sphere(uniform_float(words.z), uniform_float(words.w));
        sample->pdf_w = 0.25f * INV_PI;
    }
    sample->target = from + sample->wi * scene->lighting.far_distance;
    if (FEATURE_light_strategy) {
        sample->arrival_pdf_a = disc_pdf_a(scene->lighting, from, sample->wi);
    }
}

/// Samples a direction from point `from` towards a light, as `light_at` returns it.
DEVICE LightSample sample_one_light(PRIVATE const SceneView *scene, LightRecord light, float3 from,
                                    uint4 words) {
    LightSample sample;
    sample.pdf_w = 0.0f;
    sample.is_delta = 0u;
    if (FEATURE_light_strategy) {
        sample.sampling_over_emission = light.selection / light.emission_selection;
        sample.arrival_pdf_a = 0.0f;
    }
    if (FEATURE_area_lights && light.kind == LIGHT_MESH) {
        const LightPoint on = sample_mesh_light(scene, light, words);
        look_at_point(from, on.point, surface_radiance(scene, light, on.uv), on.pdf_a, on.pdf_a,
                      &sample);
    } else if (FEATURE_shape_lights && is_shape_light(light)) {
        const ShapeLightSample on = sample_shape_light(
            light, scene->shapes, from, uniform_float(words.z), uniform_float(words.w));
        look_at_point(from, on.point, surface_radiance(scene, light, on.uv), on.pdf_a,
                      1.0f / light.area, &sample);
    } else if ((FEATURE_point_lights || FEATURE_spot_lights) &&
               (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT)) {
        look_at_position(from, light, &sample);
    } else if (FEATURE_infinite_lights || FEATURE_directional_lights) {
        look_at_infinity(scene, from, light, words, &sample);
    }
    if (FEATURE_light_strategy && has_guide_table(light)) {
        sample.arrival_pdf_a *= guide_density(scene, light, -sample.wi);
    }
    sample.pdf_w *= light.selection;
    return sample;
}

/// Samples a direction from a point towards light `light_index`, or towards a light selected at
/// random for SELECT_LIGHT.
DEVICE LightSample sample_lights(PRIVATE const SceneView *scene, uint light_index, float3 from,
                                 uint4 words) {
    uint index = light_index;
    if (light_index == SELECT_LIGHT) {
        index = 0u;
        if (FEATURE_many_lights) {
            SELECT_BY_WORD(scene->lights, .selection_end, 0u, scene->lighting.light_count, words.x,
                           selected)
            index = selected;
        }
    }
    return sample_one_light(scene, light_at(scene, index), from, words);
}

/// Returns whether the emitter of a hit is a shape, not a triangle.
DEVICE bool is_emitting_shape(uint primitive) {
    return FEATURE_shape_lights && (!FEATURE_area_lights || (primitive & SHAPE_BIT) != 0u);
}

/// Returns the index of the light that an emitting surface belongs to.
DEVICE uint light_of_hit(PRIVATE const SceneView *scene, uint primitive, uint emitter) {
    return is_emitting_shape(primitive) ? emitter : scene->emitter_triangles[emitter].light;
}

/// Returns the density per area, with the selection probability, with which `sample_lights` samples
/// this point from `from`.
DEVICE float light_pdf_a(PRIVATE const SceneView *scene, LightRecord light, uint primitive,
                         uint emitter, float3 from, SurfacePoint point) {
    return light.selection * (is_emitting_shape(primitive)
                                  ? shape_light_pdf_a(light, scene->shapes, from, point)
                                  : scene->emitter_triangles[emitter].pdf_a);
}

// Densities of emission (EmissionSample) for paths sampled as camera paths or light samples. Lights
// are as `light_at` returns them.

/// Returns the density per area, with the selection probability, with which a light path starts at
/// a point of this emitter (of SurfaceHit). Multiplied by 1 / pi, the cosine-weighted density per
/// projected solid angle, it is the density of the ray from there, unless a table guides it.
DEVICE float emission_pdf_a(PRIVATE const SceneView *scene, LightRecord light, uint primitive,
                            uint emitter) {
    return is_emitting_shape(primitive)
               ? light.emission_selection / light.area
               : light.emission_selection * scene->emitter_triangles[emitter].pdf_a;
}

/// Returns the density per area and projected solid angle, with the selection probability, of a
/// light path in direction `d` (unit) from this emitter: pdf_origin pdf_direction / cos.
DEVICE float emission_line_pdf(PRIVATE const SceneView *scene, LightRecord light, uint primitive,
                               uint emitter, float3 d) {
    return INV_PI * emission_pdf_a(scene, light, primitive, emitter) *
           guide_density(scene, light, d);
}

/// Returns the density, with the selection probability, of a light path from infinity that arrives
/// at `point` from direction d: pdf_origin pdf_direction, per solid angle and area of the disc.
DEVICE float infinite_line_pdf(PRIVATE const SceneView *scene, float3 point, float3 d) {
    return light_at(scene, scene->lighting.infinite_light).emission_selection *
           infinite_pdf_w(scene, d) * disc_pdf_a(scene->lighting, point, d);
}

/// Returns the density with which `sample_lights`, called for `from`, samples this point or
/// direction of a light, over the density with which light paths start there. It is p_oe / p_o of
/// MIS (20) and finite. The two differ in the selection probability if every light is
/// sampled, and on spheres that are sampled by their cones. `on` (position and normal) is read for
/// such spheres only.
DEVICE float sampling_over_emission(PRIVATE const SceneView *scene, LightRecord light, float3 from,
                                    SurfacePoint on) {
    float ratio = light.selection / light.emission_selection;
    if (FEATURE_shape_lights && light.kind == LIGHT_SPHERE) {
        ratio *= light.area * shape_light_pdf_a(light, scene->shapes, from, on);
    }
    return ratio;
}
