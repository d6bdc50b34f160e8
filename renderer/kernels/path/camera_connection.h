// SPDX-License-Identifier: MIT
// Connections of a light path's hits and of its start to a point on the lens (light paths of the
// thesis, section 2.8).
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/light/light.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/mis/bidirectional.h"
#include "renderer/kernels/mis/truncated.h"
#include "renderer/kernels/path/light_start.h"
#include "renderer/kernels/path/shadow_ray.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns log2 of A_{k-1} = p_oe / (p_o E) at the first hit of a light path, MIS (20). E is the
/// density per area with which the path arrives: p_d in its measure of `pdf_direction`, times the
/// cosine, over the squared distance unless the light is at infinity.
DEVICE float first_inverse_arrival(Path path, PRIVATE const SceneView *scene, SurfaceHit hit) {
    const LightRecord light = light_at(scene, get_light(path));
    SurfacePoint start;
    start.position = get_ray_origin(path);
    start.normal = get_ray_direction(path);
    if (FEATURE_shape_lights && light.kind == LIGHT_SPHERE) {
        start.normal =
            normalize(start.position - shape_centre(scene->shapes + light.first_triangle));
    }
    const float cosine = fabs(dot(hit.point.normal, get_ray_direction(path)));
    const float3 to_hit = hit.point.position - start.position;
    const float squared = light.kind < LIGHT_DIRECTIONAL ? dot(to_hit, to_hit) : 1.0f;
    return get_log_inverse_arrival(path) +
           log2_quotient(sampling_over_emission(scene, light, hit.point.position, start) * squared,
                         cosine);
}

/// Sets A_i of MIS (20) at a hit of a light path; without vertex connections, at the first hit
/// alone. There it is 0 without the explicit strategy, since p_oe is.
DEVICE void set_light_path_arrival(Path path, PRIVATE const SceneView *scene,
                                   IntegratorSettings settings, SurfaceHit hit) {
    if (FEATURE_light_strategy && get_depth(path) == 0u) {
        const bool is_explicit =
            FEATURE_emission_density && (settings.strategies & STRATEGY_EXPLICIT) != 0u;
        set_log_inverse_arrival(path,
                                is_explicit ? first_inverse_arrival(path, scene, hit) : -INFINITY);
    } else if (FEATURE_vertex_connections) {
        const float3 to_hit = hit.point.position - get_ray_origin(path);
        const float cosine = fabs(dot(hit.point.normal, get_ray_direction(path)));
        set_log_inverse_arrival(path,
                                log_inverse_pdf_a(get_pdf_w(path), cosine, dot(to_hit, to_hit)));
    }
}

/// Returns the weight w_L of a light path that is connected to the camera at x_1. `log_f` is log2
/// of f_1, the density per projected solid angle with which a camera path continues along the light
/// path. `log_p1_over_nl` is log2 of P_1 / n_L.
DEVICE float camera_connection_weight(Path path, IntegratorSettings settings, float log_f,
                                      float log_p1_over_nl) {
    const uint depth = get_depth(path);
    const float log_a = get_log_inverse_arrival(path);
    if (FEATURE_vertex_connections && all_strategies(settings, depth + 1u)) {
        // The bracket of MIS (21) at x_1; the camera side has no vertex.
        return power_heuristic_of_log(
            log_p1_over_nl +
                strategies_before(get_log_strategies(path), log_a, log_f, settings.beta),
            settings.beta);
    }
    return light_path_weight(get_log_running_ratio(path), log_a, depth, log_f, log_p1_over_nl,
                             settings.beta);  // MIS (16)
}

/// Sets what a connection to the camera adds in every trial. `radiance` has no weight yet, `log_f`
/// and `log_p1_over_nl` are those of `camera_connection_weight`.
DEVICE void set_connection_trials(Path path, IntegratorSettings settings, float3 radiance,
                                  float log_f, float log_p1_over_nl) {
    const float value = rec709_luminance(radiance);
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        if (!trial_has_light_paths(trial)) {
            set_shadow_trial(path, trial, 0.0f);
            continue;
        }
        const float log_factor = trial_log_factor(trial);
        const float weight =
            trial_is_explicit(trial)
                ? camera_connection_weight(path, settings, log_f, log_p1_over_nl - log_factor)
                : light_path_weight(get_trial_ratio(path), -INFINITY, get_depth(path), log_f,
                                    log_p1_over_nl - log_factor, settings.beta);
        set_shadow_trial(path, trial, value * power_of_two(-log_factor) * weight);
    }
}

/// Sets what the connection of an emitter to the camera adds in every trial. `log_other` is log2
/// of p_I / p_L for the light paths that are traced.
DEVICE void set_start_trials(Path path, float3 radiance, float log_other, float beta) {
    const float value = rec709_luminance(radiance);
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        if (!trial_has_light_paths(trial)) {
            set_shadow_trial(path, trial, 0.0f);
            continue;
        }
        const float log_factor = trial_log_factor(trial);
        const float weight = power_heuristic_of_log(log_other - log_factor, beta);
        set_shadow_trial(path, trial, value * power_of_two(-log_factor) * weight);
    }
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
    set_light_path_arrival(path, scene, settings, hit);
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
    const float3 to_lens = connection.lens_point - hit.point.position;
    const float squared = dot(to_lens, to_lens);
    const float3 wo = to_lens / sqrt(squared);
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
    // P_1 of MIS (6), the density of camera paths per area at the hit.
    const float camera_pdf_a = connection.pdf_w * cos_wo / squared;
    const float light_paths = (float)settings.light_paths;
    // MIS (9)
    float3 radiance = get_throughput(path) * bsdf.f_cos * (camera_pdf_a / cos_wi / light_paths);
    if (FEATURE_light_strategy && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        const float log_f = log2_quotient(bsdf.pdf_w, cos_wi);  // per projected solid angle
        const float log_p1_over_nl = log2_quotient(camera_pdf_a, light_paths);
        if (FEATURE_light_path_trials) {
            set_connection_trials(path, settings, radiance, log_f, log_p1_over_nl);
        }
        radiance *= camera_connection_weight(path, settings, log_f, log_p1_over_nl);
    }
    aim_shadow_ray(path, offset_ray_origin(hit.point, wo), connection.lens_point, radiance);
    set_splat_pixel(path, (uint)connection.raster.y * camera.width + (uint)connection.raster.x);
    return true;
}

/// Whether light paths may show emitters that the camera sees directly.
#define SHOWS_EMITTERS                                \
    ((FEATURE_area_lights || FEATURE_shape_lights) && \
     (FEATURE_light_emitters || !FEATURE_light_strategy))

/// Connects the start of a light path to the camera and prepares the shadow ray. Returns false if
/// the camera does not see it or light paths do not show it. Spheres with a table show another
/// point than `start`. Otherwise the shadow ray has the origin of the path, which is not written.
DEVICE bool connect_start_to_camera(Path path, PRIVATE const SceneView *scene, CameraRecord camera,
                                    IntegratorSettings settings, ulong first_sample,
                                    EmissionSample start) {
    const uint index = get_pixel(path);
    const ulong sample = first_sample + get_sample(path);
    const bool seen_by_camera_alone =
        FEATURE_light_strategy &&
        (settings.strategies & (STRATEGY_LIGHT | STRATEGY_LIGHT_EMITTERS)) == STRATEGY_LIGHT;
    if (!SHOWS_EMITTERS || seen_by_camera_alone ||
        (settings.strategies & STRATEGY_EMITTERS_OUT_OF_VIEW) != 0u) {
        return false;
    }
    if (FEATURE_shadow_origin) {
        start = seen_light_path_start(scene, settings, index, sample);
    }
    if (start.is_delta != 0u || start.at_infinity != 0u) {
        return false;
    }
    const uint4 words = path_sample(settings, index, sample, BLOCK_CAMERA);
    const CameraConnection connection = camera_connection(
        camera, start.point.position, uniform_float(words.x), uniform_float(words.y));
    const float3 to_lens = connection.lens_point - start.point.position;
    const float squared = dot(to_lens, to_lens);
    const float facing = dot(start.point.normal, to_lens);  // cosine times distance
    if (!(connection.pdf_w > 0.0f && facing > 0.0f)) {
        return false;
    }
    // P_1 of MIS (6), the density of camera paths per area at the start. The path contributes
    // L_e P_1 / (n_L p_o), MIS (9) for k = 1.
    const float camera_pdf_a = connection.pdf_w * (facing / sqrt(squared)) / squared;
    const float light_pdf_a = start.pdf_origin * (float)settings.light_paths;  // p_o n_L
    float3 radiance = surface_radiance(scene, scene->lights[start.light], start.uv) *
                      (camera_pdf_a / light_pdf_a);
    if (FEATURE_light_emitters && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        // p_I / p_L = P_1 / (n_L p_o) for k = 1, the inverse of MIS (17).
        const float log_other = log2_quotient(camera_pdf_a, light_pdf_a);
        if (FEATURE_light_path_trials) {
            set_start_trials(path, radiance, log_other, settings.beta);
        }
        radiance *= power_heuristic_of_log(log_other, settings.beta);
    }
    set_shadow_origin(path, start.origin);
    set_shadow_vector(path, connection.lens_point - start.origin);
    set_shadow_radiance(path, radiance);
    set_splat_pixel(path, (uint)connection.raster.y * camera.width + (uint)connection.raster.x);
    return true;
}
