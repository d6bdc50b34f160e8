// SPDX-License-Identifier: MIT
// Connections of a light path's hits and of its start to a point on the lens (light paths of the
// thesis, section 2.8).
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/light/light.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/light/start.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/path/shadow_ray.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns log2 of p_o,explicit / (p_o E) at the first hit of a light path, where E is the density
/// per area with which the path arrives (light/mis.h).
DEVICE float explicit_over_light(Path path, PRIVATE const SceneView *scene, SurfaceHit hit) {
    const LightRecord light = scene->lights[get_light(path)];
    SurfacePoint start;
    start.position = get_ray_origin(path);
    start.normal = get_ray_direction(path);
    if (FEATURE_shape_lights && light.kind == LIGHT_SPHERE) {
        start.normal =
            normalize(start.position - shape_centre(scene->shapes + light.first_triangle));
    }
    const float cosine = fabs(dot(hit.point.normal, get_ray_direction(path)));
    const float3 way = hit.point.position - start.position;
    const float squared = light.kind < LIGHT_DIRECTIONAL ? dot(way, way) : 1.0f;
    return get_log_arrival(path) +
           log2_quotient(sampling_over_emission(scene, light, hit.point.position, start) * squared,
                         cosine);
}

/// Sets A_i of light/mis.h at a hit of a light path; without vertex connections, at the first hit
/// alone.
DEVICE void light_path_arrives(Path path, PRIVATE const SceneView *scene, SurfaceHit hit) {
    if (FEATURE_emission_density && get_depth(path) == 0u) {
        set_log_arrival(path, explicit_over_light(path, scene, hit));
    } else if (FEATURE_vertex_connections) {
        const float3 from = hit.point.position - get_ray_origin(path);
        const float cosine = fabs(dot(hit.point.normal, get_ray_direction(path)));
        set_log_arrival(path, log_inverse_pdf_a(get_pdf_w(path), cosine, dot(from, from)));
    }
}

/// Returns the weight of a light path that is connected to the camera. `log_back` is log2 of the
/// density per projected solid angle with which a camera path continues along the light path,
/// `log_first` is log2 of P_1 / n_L (light/mis.h).
DEVICE float camera_connection_weight(Path path, IntegratorSettings settings, float log_back,
                                      float log_first) {
    const uint depth = get_depth(path);
    const float log_arrival = get_log_arrival(path);
    if (FEATURE_vertex_connections && all_strategies(settings, depth + 1u)) {
        return join_weight(-INFINITY,
                           log_first + strategies_before(get_log_strategies(path), log_arrival,
                                                         log_back, settings.beta),
                           settings.beta);
    }
    return light_path_weight(get_log_ratio(path), log_arrival, depth, log_back, log_first,
                             settings.beta);
}

/// Connects a hit to the camera and prepares the shadow ray. Returns false if the connection
/// contributes nothing.
DEVICE bool connect_hit_to_camera(Path path, PRIVATE const SceneView *scene, CameraRecord camera,
                                  IntegratorSettings settings, ulong first_sample) {
    const uint primitive = get_hit_primitive(path);
    const uint depth = get_depth(path);
    if (primitive == NO_HIT) {
        return false;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(path));
    light_path_arrives(path, scene, hit);
    if ((FEATURE_depth_limit && depth >= settings.max_depth) ||
        is_delta_material(scene->materials[hit.material])) {
        return false;
    }
    const uint4 words =
        path_sample(settings, get_pixel(path), first_sample + get_sample(path), BLOCK_LIGHT(depth));
    const CameraConnection connection = camera_connection(
        camera, hit.point.position, uniform_float(words.x), uniform_float(words.y));
    if (!(connection.pdf_w > 0.0f)) {
        return false;
    }
    const float3 way = connection.lens_point - hit.point.position;
    const float squared = dot(way, way);
    const float3 wo = way / sqrt(squared);
    const float3 wi = -get_ray_direction(path);
    const float cos_wo = fabs(dot(hit.point.normal, wo));
    const float cos_wi = fabs(dot(hit.point.normal, wi));
    if (!(cos_wo > 0.0f && cos_wi > 0.0f)) {
        return false;
    }
    // The BSDF is that of radiance from wi to wo, as for a camera path. f_cos contains the cosine
    // with the shading normal, while the path's area measure has the cosine with the geometric
    // normal (Veach 1997, section 5.3).
    const BsdfValue bsdf = bsdf_evaluate(scene, hit.material, shading_frame(scene, hit, wo), wi);
    if (is_black(bsdf.f_cos)) {
        return false;
    }
    // P_1, the density of camera paths per area at the hit.
    const float camera_pdf_a = connection.pdf_w * cos_wo / squared;
    const float light_paths = (float)settings.light_paths;
    float3 radiance = get_throughput(path) * bsdf.f_cos * (camera_pdf_a / cos_wi / light_paths);
    if (FEATURE_light_strategy && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        // p_I / p_L and p_E / p_L: the product of the contribution of the previous vertices and the
        // densities at this one (light/mis.h).
        radiance *= camera_connection_weight(path, settings, log2_quotient(bsdf.pdf_w, cos_wi),
                                             log2_quotient(camera_pdf_a, light_paths));
    }
    aim_shadow_ray(path, offset_ray_origin(hit.point, wo), connection.lens_point, radiance);
    set_splat_pixel(path, (uint)connection.raster.y * camera.width + (uint)connection.raster.x);
    return true;
}

/// Connects the start of a light path to the camera and prepares the shadow ray. Returns false if
/// the camera does not see it or light paths do not show it. The origin of the shadow ray is that
/// of the path, so ray_origin is not written.
DEVICE bool connect_start_to_camera(Path path, PRIVATE const SceneView *scene, CameraRecord camera,
                                    IntegratorSettings settings, ulong first_sample) {
    const uint index = get_pixel(path);
    const ulong sample = first_sample + get_sample(path);
    const bool seen_by_camera_alone =
        FEATURE_light_strategy &&
        (settings.strategies & (STRATEGY_LIGHT | STRATEGY_LIGHT_EMITTERS)) == STRATEGY_LIGHT;
    if (get_depth(path) > 0u || seen_by_camera_alone) {
        return false;
    }
    const EmissionSample start = light_path_start(scene, settings, index, sample);
    if (start.is_delta != 0u || start.at_infinity != 0u) {
        return false;
    }
    const uint4 words = path_sample(settings, index, sample, BLOCK_CAMERA);
    const CameraConnection connection = camera_connection(
        camera, start.point.position, uniform_float(words.x), uniform_float(words.y));
    const float3 way = connection.lens_point - start.point.position;
    const float squared = dot(way, way);
    const float facing = dot(start.point.normal, way);  // cosine times distance
    if (!(connection.pdf_w > 0.0f && facing > 0.0f)) {
        return false;
    }
    // P_1, the density of camera paths per area at the start. The path contributes L P_1 / (p_o
    // n_L).
    const float camera_pdf_a = connection.pdf_w * (facing / sqrt(squared)) / squared;
    const float light_pdf_a = start.pdf_origin * (float)settings.light_paths;  // p_o n_L
    float3 radiance = light_radiance(scene->lights[start.light]) * (camera_pdf_a / light_pdf_a);
    if (FEATURE_light_emitters && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        // p_I / p_L = P_1 / (n_L p_o) of a path with one edge (light/mis.h).
        radiance *=
            camera_path_weight(0.0f, log2_quotient(camera_pdf_a, light_pdf_a), settings.beta);
    }
    set_shadow_vector(path, connection.lens_point - start.origin);
    set_shadow_radiance(path, radiance);
    set_splat_pixel(path, (uint)connection.raster.y * camera.width + (uint)connection.raster.x);
    return true;
}
