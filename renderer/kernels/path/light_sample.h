// SPDX-License-Identifier: MIT
// Connections of a hit to a point sampled on a light: explicit paths, also called next-event
// estimation.
#pragma once

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/reverse.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/light/light.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/mis/bidirectional.h"
#include "renderer/kernels/mis/truncated.h"
#include "renderer/kernels/path/scatter_table.h"
#include "renderer/kernels/path/shadow_ray.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns log2 of p_L / p_E at x_{k-1}, where k = `depth` + 2: MIS (12). If light vertices are
/// stored, it is the sum over all strategies with a light path, as in MIS (21).
DEVICE float light_over_explicit(Path path, PRIVATE const SceneView *scene, SurfaceHit hit,
                                 float3 wo, LightSample light, IntegratorSettings settings) {
    const uint depth = get_depth(path);
    const float cos_wo = fabs(dot(hit.point.normal, wo));
    // A zero cosine would make log_b +INFINITY, and its sum with -INFINITY is NaN.
    if (!(cos_wo > 0.0f)) {
        return -INFINITY;
    }
    // log2 of E p_o / p_oe. E is per area: `arrival_pdf_a` times the cosine at the hit.
    const float log_arrival = log2_quotient(
        light.arrival_pdf_a * fabs(dot(hit.point.normal, light.wi)), light.sampling_over_emission);
    const float log_r = get_log_running_ratio(path);
    const bool all = FEATURE_vertex_connections && all_strategies(settings, depth + 1u);
    if (depth == 0u || (!all && !(log_r > -INFINITY))) {
        return log_r + log_arrival;  // MIS (12), k = 2
    }
    // log2 of b_{k-1}, per projected solid angle.
    const float log_b =
        is_lambertian(scene, hit)
            ? LOG2_INV_PI
            : log2_quotient(
                  light_path_pdf_w(scene, hit.material, shading_frame(scene, hit, light.wi), wo),
                  cos_wo);
    if (all) {
        // The bracket of MIS (21) at x_{k-1}.
        return log_arrival + strategies_before(get_log_strategies(path),
                                               get_log_inverse_arrival(path), log_b, settings.beta);
    }
    return log_r + log_arrival + log_b;  // MIS (12), k >= 3
}

/// Connects the hit of a path to light `light_index`, or to a light selected at random for
/// SELECT_LIGHT, by the words of BLOCK_LIGHT, and prepares the shadow ray. Returns false if the
/// connection contributes nothing.
DEVICE bool connect_to_light(Path path, PRIVATE const SceneView *scene, IntegratorSettings settings,
                             uint4 words, uint light_index) {
    const uint primitive = get_hit_primitive(path);
    const uint depth = get_depth(path);
    if (primitive == NO_HIT || (settings.strategies & STRATEGY_EXPLICIT) == 0u) {
        return false;
    }
    if (FEATURE_depth_limit && depth >= settings.max_depth) {
        return false;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(path));
    if (is_delta_material(scene->materials[hit.material])) {
        return false;
    }
    const LightSample light = sample_lights(scene, light_index, hit.point.position, words);
    if (!(light.pdf_w > 0.0f)) {
        return false;
    }
    const SurfaceFrame frame = shading_frame(scene, hit, -get_ray_direction(path));
    const BsdfValue bsdf = bsdf_evaluate(scene, hit.material, frame, light.wi);
    if (is_black(bsdf.f_cos)) {
        return false;
    }
    // f cos L / p_E of thesis (2.62).
    float3 radiance = get_throughput(path) * bsdf.f_cos * light.radiance / light.pdf_w;
    if (FEATURE_implicit_light) {
        // p_I / p_E of MIS (7), thesis (2.73), both per solid angle.
        const bool by_hit = light.is_delta == 0u && (settings.strategies & STRATEGY_IMPLICIT) != 0u;
        float by_implicit = 0.0f;
        if (by_hit) {
            const uint table = scatter_table(path, scene, settings, hit, frame.ng);
            by_implicit = guided_pdf_w(scene, table, bsdf.pdf_w, light.wi) / light.pdf_w;
        }
        if (FEATURE_light_strategy && (settings.strategies & STRATEGY_LIGHT) != 0u) {
            const float log_light =
                light_over_explicit(path, scene, hit, frame.wo, light, settings);
            if (FEATURE_light_path_trials) {
                set_light_sample_trials(path, radiance, by_implicit, log_light, settings.beta);
            }
            radiance *= camera_path_weight(by_implicit, log_light, settings.beta);  // MIS (13)
        } else if (by_hit) {
            radiance *= power_heuristic(by_implicit, settings.beta);  // MIS (8)
        }
    }
    aim_shadow_ray(path, offset_ray_origin(hit.point, light.wi), light.target, radiance);
    return true;
}
