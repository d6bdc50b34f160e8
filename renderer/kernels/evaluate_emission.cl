// SPDX-License-Identifier: MIT
// Stage evaluate_emission: implicit paths, whose last vertex was found by hitting an emitter, and emitters seen
// directly (k = 1, which every strategy counts).
// Reads: hit, ray, pdf_w, throughput, active queue. Writes: radiance.

#include "renderer/kernels/geometry/surface.h"
#include "renderer/kernels/light/area_light.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_buffers.h"

/// Adds what the hit of a path emits towards it.
DEVICE void add_emission(PathStates paths, uint slot, SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings) {
    const uint triangle = get_hit_triangle(paths, slot);
    if (triangle == NO_HIT) {
        return;
    }
    GLOBAL const SurfaceTriangle *surface = surface_triangles + triangle;
    const uint depth = get_depth(paths, slot);
    if (surface->emitter == NO_EMITTER || (depth > 0u && (settings.strategies & STRATEGY_IMPLICIT) == 0u)) {
        return;
    }
    const EmitterTriangle emitter = emitter_triangles[surface->emitter];
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

__kernel void evaluate_emission(SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings, STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, active_count(counters)) {
        add_emission(paths, active_slot(queues, counters, capacity, i), SURFACE_ARGUMENTS LIGHT_ARGUMENTS settings);
    }
}
