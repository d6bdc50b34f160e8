// SPDX-License-Identifier: MIT
// Stage evaluate_emission: implicit paths, whose last vertex was found by hitting an emitter, and emitters seen
// directly (k = 1, which every strategy counts).
// Reads: hit, ray, pdf_w, throughput, active queue. Writes: radiance.

#include "kernels/geometry/surface.h"
#include "kernels/light/area_light.h"
#include "kernels/light/mis.h"
#include "kernels/stream.h"
#include "kernels/traversal/intersect_triangle.h"
#include "shared/integrator_settings.h"
#include "shared/path_state.h"
#include "shared/scene_buffers.h"

__kernel void evaluate_emission(SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings, STREAM_PARAMETERS) {
    const uint i = get_global_id(0);
    if (i >= active_count(counters)) {
        return;
    }
    const uint slot = active_slot(queues, counters, capacity, i);
    const PathStates paths = {path_words, capacity};
    const uint triangle = get_hit_triangle(paths, slot);
    if (triangle == NO_HIT) {
        return;
    }
    const SurfaceTriangle surface = surface_triangles[triangle];
    const uint depth = get_depth(paths, slot);
    if (surface.emitter == NO_EMITTER || (depth > 0u && (settings.strategies & STRATEGY_IMPLICIT) == 0u)) {
        return;
    }
    const EmitterTriangle emitter = emitter_triangles[surface.emitter];
    const LightRecord light = lights[emitter.light];
    const SurfacePoint point = scene_point(surface, get_hit_u(paths, slot), get_hit_v(paths, slot));
    const float3 direction = get_ray_direction(paths, slot);
    const float cos_light = -dot(point.normal, direction);
    if (!(cos_light > 0.0f)) {
        return;
    }
    float3 radiance = make_float3(light.radiance[0], light.radiance[1], light.radiance[2]);
#if FEATURE_scattering
    radiance *= get_throughput(paths, slot);
#if FEATURE_implicit_light && FEATURE_explicit_light
    if (depth > 0u && (settings.strategies & STRATEGY_EXPLICIT) != 0u) {
        // p_E / p_I of thesis (2.73), per area at the light: p_I = pdf_w cos / d^2. pdf_w and cos are positive.
        const float3 way = point.position - get_ray_origin(paths, slot);
        const float ratio = light_pdf_a(light, emitter) * dot(way, way) / (get_pdf_w(paths, slot) * cos_light);
        radiance *= power_heuristic(ratio, settings.beta);
    }
#endif
#endif
    set_radiance(paths, slot, get_radiance(paths, slot) + radiance);
}
