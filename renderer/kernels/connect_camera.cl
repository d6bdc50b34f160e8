// SPDX-License-Identifier: MIT
// Stage connect_camera: connects the hit of each light path to a point on the lens (light paths of
// the thesis, section 2.8).
//
// Reads: hit, ray_origin, ray_direction, throughput, depth, pixel, sample, pdf_w, light, log_ratio,
// log_arrival, log_strategies, active queue.
// Writes: ray_origin (now that of the shadow ray), shadow_vector, shadow_radiance, splat_pixel,
// log_arrival.
// Enqueues: shadow queue.

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/bsdf/shading_frame.h"
#include "renderer/kernels/camera/perspective.h"
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

/// Returns log2 of p_o,explicit / (p_o E) at the first hit of a light path, where E is the density
/// per area with which the path arrives (light/mis.h).
DEVICE float explicit_over_light(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                                 SurfaceHit hit) {
    const LightRecord light = scene->lights[get_light(paths, slot)];
    SurfacePoint start;
    start.position = get_ray_origin(paths, slot);
    start.normal = get_ray_direction(paths, slot);
    if (FEATURE_shape_lights && light.kind == LIGHT_SPHERE) {
        start.normal =
            normalize(start.position - shape_centre(scene->shapes + light.first_triangle));
    }
    const float cosine = fabs(dot(hit.point.normal, get_ray_direction(paths, slot)));
    const float3 way = hit.point.position - start.position;
    const float squared = light.kind < LIGHT_DIRECTIONAL ? dot(way, way) : 1.0f;
    return get_log_arrival(paths, slot) +
           log2_quotient(sampling_over_emission(scene, light, hit.point.position, start) * squared,
                         cosine);
}

/// Connects a hit to the camera and prepares the shadow ray. Returns false if the connection
/// contributes nothing.
DEVICE bool join_hit(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                     CameraRecord camera, IntegratorSettings settings, ulong first_sample) {
    const uint primitive = get_hit_primitive(paths, slot);
    const uint depth = get_depth(paths, slot);
    if (primitive == NO_HIT) {
        return false;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(paths, slot));
    if (FEATURE_emission_density && depth == 0u) {
        set_log_arrival(paths, slot, explicit_over_light(paths, slot, scene, hit));
    }
    if (FEATURE_vertex_joins && depth > 0u) {
        const float3 from = hit.point.position - get_ray_origin(paths, slot);
        const float cosine = fabs(dot(hit.point.normal, get_ray_direction(paths, slot)));
        set_log_arrival(paths, slot,
                        log_inverse_pdf_a(get_pdf_w(paths, slot), cosine, dot(from, from)));
    }
    if (FEATURE_depth_limit && depth >= settings.max_depth) {
        return false;
    }
    if (is_delta_material(scene->materials[hit.material])) {
        return false;
    }
    const uint4 words = path_sample(settings, get_pixel(paths, slot),
                                    first_sample + get_sample(paths, slot), BLOCK_LIGHT(depth));
    const CameraJoin join =
        join_camera(camera, hit.point.position, uniform_float(words.x), uniform_float(words.y));
    if (!(join.pdf_w > 0.0f)) {
        return false;
    }
    const float3 way = join.lens_point - hit.point.position;
    const float squared = dot(way, way);
    const float3 wo = way / sqrt(squared);
    const float3 wi = -get_ray_direction(paths, slot);
    const float cos_wo = fabs(dot(hit.point.normal, wo));
    const float cos_wi = fabs(dot(hit.point.normal, wi));
    if (!(cos_wo > 0.0f && cos_wi > 0.0f)) {
        return false;
    }
    // The BSDF is that of radiance from wi to wo, as for a camera path. f_cos contains the cosine
    // with the shading normal, while the path's area measure has the cosine with the geometric
    // normal (Veach 1997, section 5.3).
    const BsdfValue bsdf = bsdf_evaluate(scene, hit.material, shading_frame(scene, hit, wo), wi);
    if (!(bsdf.f_cos.x > 0.0f || bsdf.f_cos.y > 0.0f || bsdf.f_cos.z > 0.0f)) {
        return false;
    }
    // P_1, the density of camera paths per area at the hit.
    const float camera_pdf_a = join.pdf_w * cos_wo / squared;
    const float light_paths = (float)settings.light_paths;
    float3 radiance =
        get_throughput(paths, slot) * bsdf.f_cos * (camera_pdf_a / cos_wi / light_paths);
    if (FEATURE_light_strategy && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        // p_I / p_L and p_E / p_L: the product of the contribution of the previous vertices and the
        // densities at this one (light/mis.h).
        const float log_first = log2_quotient(camera_pdf_a, light_paths);
        const float log_back = log2_quotient(bsdf.pdf_w, cos_wi);
        const float log_arrival = get_log_arrival(paths, slot);
        if (FEATURE_vertex_joins && all_strategies(settings, depth + 1u)) {
            radiance *=
                join_weight(-INFINITY,
                            log_first + strategies_before(get_log_strategies(paths, slot),
                                                          log_arrival, log_back, settings.beta),
                            settings.beta);
        } else {
            radiance *= light_path_weight(get_log_ratio(paths, slot), log_arrival, depth, log_back,
                                          log_first, settings.beta);
        }
    }
    const float3 origin = offset_ray_origin(hit.point, wo);
    set_ray_origin(paths, slot, origin);
    set_shadow_vector(paths, slot, join.lens_point - origin);
    set_shadow_radiance(paths, slot, radiance);
    set_splat_pixel(paths, slot, (uint)join.raster.y * camera.width + (uint)join.raster.x);
    return true;
}

#if !PATH_STATES_PRIVATE

__kernel void connect_camera(SHADING_PARAMETERS, CameraRecord camera, IntegratorSettings settings,
                             ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    PushBuffer shadow;
    shadow.count = 0u;
    GLOBAL const uint *queue = active_queue(queues, counters, capacity);
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = shaded_path_at(&scene, paths, queue, i, i_end);
        if (join_hit(paths, slot, &scene, camera, settings, first_sample)) {
            push_slot(&shadow, slot);
        }
    }
    append_slots(queues, QUEUE_SHADOW, capacity, &counters->shadow, counters, &shadow);
}

#endif
