// SPDX-License-Identifier: MIT
// Stage extend_path: samples the next direction of each active path, or ends the path and adds it
// to the film.
//
// Reads: hit, ray_direction, throughput, radiance, depth, pixel, sample, roulette_scale, log_ratio,
// log_arrival, log_strategies, active queue.
// Writes: ray_origin, ray_direction, throughput, depth, roulette_scale, pdf_w, log_ratio,
// log_strategies; film, half film.
// Enqueues: active queue of the next round, or free queue.

#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/geometry/prefetch_hit.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/live_pixels.h"
#include "renderer/shared/path_state.h"

#if FEATURE_scattering

#include "renderer/kernels/bsdf/reverse.h"

/// Samples scattering at the hit and moves the path's ray there. Returns false if the path ends.
DEVICE bool scatter(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                    IntegratorSettings settings, ulong first_sample) {
    const uint primitive = get_hit_primitive(paths, slot);
    const uint depth = get_depth(paths, slot);
    if (primitive == NO_HIT) {
        return false;
    }
#if FEATURE_depth_limit
    // The ray of the last scattering event counts only if it can find light: in implicit paths, or
    // after a delta event. A light path needs no such ray, since its last event is the one
    // connected to the camera.
#if FEATURE_from_light
    const uint last_ray = 1u;
#else
    const uint last_ray =
        FEATURE_delta || (settings.strategies & STRATEGY_IMPLICIT) != 0u ? 0u : 1u;
#endif
    if (depth + last_ray >= settings.max_depth) {
        return false;
    }
#endif
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(paths, slot));
    const SurfaceFrame frame = shading_frame(scene, hit, -get_ray_direction(paths, slot));
    const uint4 words = path_sample(settings, get_pixel(paths, slot),
                                    first_sample + get_sample(paths, slot), BLOCK_SCATTER(depth));
    const BsdfSample sample = bsdf_sample(scene, hit.material, frame, uniform_float(words.w),
                                          uniform_float(words.x), uniform_float(words.y));
    if (!(sample.pdf_w > 0.0f)) {
        return false;
    }
#if FEATURE_light_strategy || FEATURE_from_light
    const TwoWay both = look_back(scene, hit, frame, sample);
#endif
#if FEATURE_from_light
    float3 throughput = get_throughput(paths, slot) * both.importance;
    // Importance crosses boundaries unchanged.
    const float scale_change = 1.0f;
#else
    float3 throughput = get_throughput(paths, slot) * sample.weight;
    const float scale_change = sample.scale;
#endif
    const float largest = max(throughput.x, max(throughput.y, throughput.z));
    if (!(largest > 0.0f)) {
        return false;
    }
#if FEATURE_roulette
    if (settings.termination == TERMINATION_ROULETTE) {
        // Thesis, section 2.7.2: from the first bounce on, the continuation probability is
        // proportional to throughput. The bound below 1 ends paths between surfaces that absorb
        // nothing. It is close to 1 because the variance is infinite if the squared albedo exceeds
        // it. The probability is part of the contribution, but not of the MIS densities.
        // Inside glass radiance is larger by eta^2, a factor that the path loses on its way out.
        // Roulette excludes this factor (PBRT 4th ed., section 13.2.2). The throughput of a light
        // path is measured relative to its initial value.
#if FEATURE_roulette_scale
        const float scale = get_roulette_scale(paths, slot) * scale_change;
        set_roulette_scale(paths, slot, scale);
#else
        const float scale = 1.0f;
#endif
        const float continuation = min(largest / scale, settings.max_continuation);
        if (!(uniform_float(words.z) < continuation)) {
            return false;
        }
        throughput = throughput / continuation;
    }
#endif
#if FEATURE_adaptive
    if (settings.termination == TERMINATION_ADAPTIVE && largest < settings.adaptive_threshold) {
        return false;
    }
#endif
    set_ray_origin(paths, slot, offset_ray_origin(hit.point, sample.wi));
    set_ray_direction(paths, slot, sample.wi);
    set_throughput(paths, slot, throughput);
    set_depth(paths, slot, depth + 1u);
#if FEATURE_direction_density
    set_pdf_w(paths, slot, sample.pdf_w);
#endif
#if FEATURE_light_strategy
    if ((settings.strategies & STRATEGY_LIGHT) != 0u) {
        const bool is_delta = !(sample.pdf_w < INFINITY);
#if FEATURE_from_light
        set_log_ratio(
            paths, slot,
            continue_light_ratio(get_log_ratio(paths, slot), get_log_arrival(paths, slot), depth,
                                 is_delta, both.log_forward, both.log_ratio, settings.beta));
#else
        set_log_ratio(paths, slot,
                      continue_camera_ratio(get_log_ratio(paths, slot), depth, is_delta,
                                            both.log_forward, both.log_ratio));
#endif
#if FEATURE_vertex_joins
        set_log_strategies(
            paths, slot,
            continue_strategies(get_log_strategies(paths, slot), get_log_arrival(paths, slot),
                                is_delta, both.log_forward, both.log_ratio, settings.beta));
#endif
    }
#endif
    return true;
}

#endif

/// Adds a path that ends here to the film.
DEVICE void end_path(PathStates paths, uint slot, FilmView film, MAYBE_UNUSED ulong first_sample) {
#if FEATURE_from_camera
#if FEATURE_convergence
    if (add_path(paths, slot, film)) {
        add_path_to_half(paths, slot, film, first_sample);
    }
#else
    add_path(paths, slot, film);
#endif
#endif
}

#if !PATH_STATES_PRIVATE

__kernel void extend_path(SHADING_PARAMETERS, GLOBAL long *film_words, GLOBAL long *half_film_words,
                          IntegratorSettings settings, ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    const FilmView film = {film_words, half_film_words, counters};
    PushBuffer extended, ended;
    extended.count = 0u;
    ended.count = 0u;
    GLOBAL const uint *queue = active_queue(queues, counters, capacity);
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = shaded_path_at(&scene, paths, queue, i, i_end);
#if FEATURE_scattering
        if (scatter(paths, slot, &scene, settings, first_sample)) {
            push_slot(&extended, slot);
            continue;
        }
#endif
#if FEATURE_from_camera
        prefetch_pixel(film, get_pixel(paths, slot), get_radiance(paths, slot));
#endif
        push_slot(&ended, slot);
    }
    for (uint i = 0u; i < ended.count; ++i) {
        end_path(paths, ended.slots[i], film, first_sample);
    }
    append_active(queues, counters, capacity, 1u - counters->parity, &extended);
    append_slots(queues, QUEUE_FREE, capacity, &counters->free_slots, counters, &ended);
}

#endif
