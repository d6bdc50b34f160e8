// SPDX-License-Identifier: MIT
// Stage extend_path: samples the next direction of each active path, or ends the path and adds it to the film.
// Reads: hit, ray_direction, throughput, radiance, active queue. Writes: ray, throughput, pdf_w, depth; film.
// To: the active queue of the next round, or the free queue.

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/film/film.h"
#include "renderer/kernels/geometry/surface.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_buffers.h"

#if FEATURE_scattering

/// Samples the scattering at the hit and moves the path's ray on. False when the path ends here.
DEVICE bool scatter(PathStates paths, uint slot, SURFACE_PARAMETERS IntegratorSettings settings, ulong first_sample) {
    const uint triangle = get_hit_triangle(paths, slot);
    const uint depth = get_depth(paths, slot);
    if (triangle == NO_HIT) {
        return false;
    }
#if FEATURE_depth_limit
    // Without implicit paths the ray of the last scattering event could find nothing that counts.
    const uint last_ray = (settings.strategies & STRATEGY_IMPLICIT) != 0u ? 0u : 1u;
    if (depth + last_ray >= settings.max_depth) {
        return false;
    }
#endif
    GLOBAL const SurfaceTriangle *surface = surface_triangles + triangle;
    const SurfacePoint point = scene_point(surface, get_hit_u(paths, slot), get_hit_v(paths, slot));
    const float3 direction = get_ray_direction(paths, slot);
    const float3 n = dot(point.normal, direction) > 0.0f ? -point.normal : point.normal;
    const uint4 words = random_words(settings.seed, STREAM_CAMERA, get_pixel(paths, slot),
                                     first_sample + get_sample(paths, slot), BLOCK_SCATTER(depth));
    const BsdfSample sample = bsdf_sample(components[materials[surface->material].first_component], n, uniform_float(words.x), uniform_float(words.y));
    float3 throughput = get_throughput(paths, slot) * sample.weight;
    const float largest = max(throughput.x, max(throughput.y, throughput.z));
    if (!(largest > 0.0f && sample.pdf_w > 0.0f)) {
        return false;
    }
#if FEATURE_roulette
    if (settings.termination == TERMINATION_ROULETTE) {
        // Thesis 2.7.2: from the first bounce, continuation proportional to throughput. The bound below 1 ends
        // paths between surfaces that absorb nothing; it is close to 1 because the variance is infinite where the
        // squared albedo exceeds it. Left out of all MIS densities, kept in the contribution.
        const float continuation = min(largest, settings.max_continuation);
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
    set_ray_origin(paths, slot, offset_ray_origin(point, sample.wi));
    set_ray_direction(paths, slot, sample.wi);
    set_throughput(paths, slot, throughput);
    set_depth(paths, slot, depth + 1u);
#if FEATURE_implicit_light
    set_pdf_w(paths, slot, sample.pdf_w);
#endif
    return true;
}

#endif

__kernel void extend_path(SURFACE_PARAMETERS GLOBAL long *film, IntegratorSettings settings, ulong first_sample,
                          STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    PushBuffer extended, ended;
    extended.count = 0u;
    ended.count = 0u;
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = active_slot(queues, counters, capacity, i);
#if FEATURE_scattering
        if (scatter(paths, slot, SURFACE_ARGUMENTS settings, first_sample)) {
            push_slot(&extended, slot);
            continue;
        }
#endif
        const ulong pixel = get_pixel(paths, slot);
        const uint error = film_add_sample(film + pixel * FILM_PIXEL_WORDS(FEATURE_variance), get_radiance(paths, slot));
        if (error != 0u) {
            atomic_inc(error == FILM_NON_FINITE ? &counters->non_finite : &counters->out_of_range);
        }
        push_slot(&ended, slot);
    }
    append_active(queues, counters, capacity, 1u - counters->parity, &extended);
    append_slots(queues, QUEUE_FREE, capacity, &counters->free_slots, counters, &ended);
}
