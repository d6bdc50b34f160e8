// SPDX-License-Identifier: MIT
// Stage sample_light: connects the hit of each active path to a point sampled on a light (explicit
// paths).
//
// Reads: hit, ray_direction, throughput, depth, pixel, sample, log_ratio, log_arrival,
// log_strategies, active queue.
// Writes: ray_origin (now that of the shadow ray), shadow_vector, shadow_radiance.
// Enqueues: shadow queue.

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/geometry/prefetch_hit.h"
#include "renderer/kernels/light/light.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns log2 of p_L / p_E (light/mis.h). If light vertices are stored, p_L stands for all
/// strategies that involve light paths.
DEVICE float light_over_explicit(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                                 SurfaceHit hit, float3 wo, LightSample light,
                                 IntegratorSettings settings) {
    const uint depth = get_depth(paths, slot);
    const float cos_wo = fabs(dot(hit.point.normal, wo));
    // A zero cosine would make log_back +INFINITY, and its sum with -INFINITY is NaN.
    if (!(cos_wo > 0.0f)) {
        return -INFINITY;
    }
    const float log_arrive = log2_quotient(
        light.arrival_pdf_a * fabs(dot(hit.point.normal, light.wi)), light.sampling_over_emission);
    const float log_ratio = get_log_ratio(paths, slot);
    const bool all = FEATURE_vertex_joins && all_strategies(settings, depth + 1u);
    if (depth == 0u || (!all && !(log_ratio > -INFINITY))) {
        return log_ratio + log_arrive;
    }
    const SurfaceFrame back = shading_frame(scene, hit, light.wi);
    const float log_back =
        log2_quotient(bsdf_evaluate(scene, hit.material, back, wo).pdf_w, cos_wo);
    if (all) {
        return log_arrive + strategies_before(get_log_strategies(paths, slot),
                                              get_log_arrival(paths, slot), log_back,
                                              settings.beta);
    }
    return log_ratio + log_arrive + log_back;
}

/// Connects the hit of a path to light `chosen`, or to a light selected at random for SELECT_LIGHT,
/// and prepares the shadow ray. Returns false if the connection contributes nothing.
DEVICE bool join_to_light(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                          IntegratorSettings settings, ulong first_sample, uint chosen) {
    const uint primitive = get_hit_primitive(paths, slot);
    const uint depth = get_depth(paths, slot);
    if (primitive == NO_HIT || (settings.strategies & STRATEGY_EXPLICIT) == 0u) {
        return false;
    }
    if (FEATURE_depth_limit && depth >= settings.max_depth) {
        return false;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(paths, slot));
    if (is_delta_material(scene->materials[hit.material])) {
        return false;
    }
    // Lights that are sampled one after the other have their own random streams.
    const uint stream = chosen == SELECT_LIGHT ? STREAM_CAMERA : STREAM_LIGHT(chosen);
    const uint4 words = sample_words(settings, stream, get_pixel(paths, slot),
                                     first_sample + get_sample(paths, slot), BLOCK_LIGHT(depth));
    const LightSample light = sample_lights(scene, chosen, hit.point.position, words);
    if (!(light.pdf_w > 0.0f)) {
        return false;
    }
    const SurfaceFrame frame = shading_frame(scene, hit, -get_ray_direction(paths, slot));
    const BsdfValue bsdf = bsdf_evaluate(scene, hit.material, frame, light.wi);
    if (!(bsdf.f_cos.x > 0.0f || bsdf.f_cos.y > 0.0f || bsdf.f_cos.z > 0.0f)) {
        return false;
    }
    // f cos L / p_E of thesis (2.62).
    float3 radiance = get_throughput(paths, slot) * bsdf.f_cos * light.radiance / light.pdf_w;
    if (FEATURE_implicit_light) {
        // p_I / p_E of thesis (2.73), both per solid angle.
        const bool by_hit = light.is_delta == 0u && (settings.strategies & STRATEGY_IMPLICIT) != 0u;
        const float by_implicit = by_hit ? bsdf.pdf_w / light.pdf_w : 0.0f;
        if (FEATURE_light_strategy && (settings.strategies & STRATEGY_LIGHT) != 0u) {
            const float log_light =
                light_over_explicit(paths, slot, scene, hit, frame.wo, light, settings);
            radiance *= camera_path_weight(by_implicit, log_light, settings.beta);
        } else if (by_hit) {
            radiance *= power_heuristic(by_implicit, settings.beta);
        }
    }
    const float3 origin = offset_ray_origin(hit.point, light.wi);
    set_ray_origin(paths, slot, origin);
    set_shadow_vector(paths, slot, light.target - origin);
    set_shadow_radiance(paths, slot, radiance);
    return true;
}

#if !PATH_STATES_PRIVATE

__kernel void sample_light(SHADING_PARAMETERS, IntegratorSettings settings, ulong first_sample,
                           uint chosen, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    PushBuffer shadow;
    shadow.count = 0u;
    GLOBAL const uint *queue = active_queue(queues, counters, capacity);
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = shaded_path_at(&scene, paths, queue, i, i_end);
        if (join_to_light(paths, slot, &scene, settings, first_sample, chosen)) {
            push_slot(&shadow, slot);
        }
    }
    append_slots(queues, QUEUE_SHADOW, capacity, &counters->shadow, counters, &shadow);
}

#endif
