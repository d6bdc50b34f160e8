// SPDX-License-Identifier: MIT
// Stage sample_light: joins the hit of each active path to a point sampled on a light (explicit paths).
// Reads: hit, ray_direction, throughput, active queue. Writes: ray_origin (now that of the shadow ray),
// shadow_vector, shadow_radiance. To: the shadow queue.

#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/geometry/surface.h"
#include "renderer/kernels/light/area_light.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_buffers.h"

/// Prepares the shadow ray of a path. False when there is nothing to gain.
DEVICE bool join_to_light(PathStates paths, uint slot, SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings,
                          ulong first_sample) {
    const uint triangle = get_hit_triangle(paths, slot);
    const uint depth = get_depth(paths, slot);
    if (triangle == NO_HIT || (settings.strategies & STRATEGY_EXPLICIT) == 0u) {
        return false;
    }
#if FEATURE_depth_limit
    if (depth >= settings.max_depth) {
        return false;
    }
#endif
    GLOBAL const SurfaceTriangle *surface = surface_triangles + triangle;
    const SurfacePoint point = scene_point(surface, get_hit_u(paths, slot), get_hit_v(paths, slot));
    const float3 direction = get_ray_direction(paths, slot);
    const float3 n = dot(point.normal, direction) > 0.0f ? -point.normal : point.normal;  // on wo's side

    const uint4 words = random_words(settings.seed, STREAM_CAMERA, get_pixel(paths, slot),
                                     first_sample + get_sample(paths, slot), BLOCK_LIGHT(depth));
    const LightSample light = sample_light_point(lights, emitter_triangles, surface_triangles, light_count, words);
    const float3 way = light.point.position - point.position;
    const float distance2 = dot(way, way);
    // The sides are decided without dividing by the distance, which may be 0 where surface and light touch.
    if (!(dot(n, way) > 0.0f && dot(light.point.normal, way) < 0.0f)) {
        return false;
    }
    const float3 wi = way / sqrt(distance2);
    const float cos_surface = dot(n, wi);
    const float cos_light = -dot(light.point.normal, wi);
    const BxdfRecord component = components[materials[surface->material].first_component];
    const float3 f = bsdf_evaluate(component, n, wi);
    if (!(f.x > 0.0f || f.y > 0.0f || f.z > 0.0f)) {
        return false;
    }
    // f cos L / p_E, p_E converted from area to solid angle: thesis (2.62).
    float3 radiance = get_throughput(paths, slot) * f * light.radiance *
                      (cos_surface * cos_light / (distance2 * light.pdf_a));
#if FEATURE_implicit_light
    if ((settings.strategies & STRATEGY_IMPLICIT) != 0u) {
        // p_I / p_E, per area at the light: thesis (2.73).
        const float ratio = bsdf_pdf(n, wi) * cos_light / (distance2 * light.pdf_a);
        radiance *= power_heuristic(ratio, settings.beta);
    }
#endif
    const float3 origin = offset_ray_origin(point, way);
    set_ray_origin(paths, slot, origin);
    set_shadow_vector(paths, slot, offset_ray_origin(light.point, -way) - origin);
    set_shadow_radiance(paths, slot, radiance);
    return true;
}

__kernel void sample_light(SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings, ulong first_sample,
                           STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    PushBuffer shadow;
    shadow.count = 0u;
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = active_slot(queues, counters, capacity, i);
        if (join_to_light(paths, slot, SURFACE_ARGUMENTS LIGHT_ARGUMENTS settings, first_sample)) {
            push_slot(&shadow, slot);
        }
    }
    append_slots(queues, QUEUE_SHADOW, capacity, &counters->shadow, counters, &shadow);
}
