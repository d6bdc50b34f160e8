// SPDX-License-Identifier: MIT
// Stage evaluate_emission: adds what the hit of each active path, or the light at infinity, emits towards it: emitters
// seen directly, and implicit paths.
// Reads: hit, ray_origin, ray_direction, throughput, pdf_w, depth, active queue. Writes: radiance.

#include "renderer/kernels/light/light.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/stream.h"
#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/scene_buffers.h"

/// What a path meets: radiance towards it, and the density per solid angle with which light sampling at the vertex
/// before would have found it.
typedef struct Emission {
    float3 radiance;
    float explicit_pdf_w;
} Emission;

/// False when nothing is emitted this way. `density_needed`: explicit_pdf_w is to be set.
DEVICE bool emission_met(PathStates paths, uint slot, SURFACE_PARAMETERS LIGHT_PARAMETERS bool density_needed,
                         PRIVATE Emission *met) {
    const uint primitive = get_hit_primitive(paths, slot);
    const float3 direction = get_ray_direction(paths, slot);
    met->explicit_pdf_w = 0.0f;
    if (primitive == NO_HIT) {
#if FEATURE_infinite_lights
        if (lighting.infinite_light == NO_EMITTER) {
            return false;
        }
        met->radiance = infinite_radiance(LIGHT_ARGUMENTS direction);
        if (density_needed) {
            met->explicit_pdf_w = lights[lighting.infinite_light].selection * infinite_pdf_w(LIGHT_ARGUMENTS direction);
        }
        return true;
#else
        return false;
#endif
    }
#if FEATURE_area_lights || FEATURE_shape_lights
    const SurfaceHit hit = surface_hit(SURFACE_ARGUMENTS primitive, get_hit_at(paths, slot));
    if (hit.emitter == NO_EMITTER || !(dot(hit.point.normal, direction) < 0.0f)) {
        return false;
    }
    const LightRecord light = lights[light_of_hit(LIGHT_ARGUMENTS primitive, hit.emitter)];
    met->radiance = light_radiance(light);
    if (density_needed) {
        const float3 from = get_ray_origin(paths, slot);
        met->explicit_pdf_w =
            light_pdf_a(SURFACE_ARGUMENTS LIGHT_ARGUMENTS light, primitive, hit.emitter, from, hit.point) *
            solid_angle_per_area(hit.point.position - from, hit.point.normal);
    }
    return true;
#else
    return false;
#endif
}

DEVICE void add_emission(PathStates paths, uint slot, SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings) {
    bool weighted = false;
#if FEATURE_scattering
    if (get_depth(paths, slot) > 0u) {
#if FEATURE_direction_density
        // After a delta event light sampling had no chance: only implicit paths find this light, whatever the strategy.
        if (get_pdf_w(paths, slot) < INFINITY) {
            if ((settings.strategies & STRATEGY_IMPLICIT) == 0u) {
                return;
            }
            weighted = (settings.strategies & STRATEGY_EXPLICIT) != 0u;
        }
#else
        return;
#endif
    }
#endif
    Emission met;
    if (!emission_met(paths, slot, SURFACE_ARGUMENTS LIGHT_ARGUMENTS weighted, &met)) {
        return;
    }
    float3 radiance = met.radiance;
#if FEATURE_scattering
    radiance *= get_throughput(paths, slot);
#endif
#if FEATURE_direction_density
    if (weighted) {
        // p_E / p_I of thesis (2.73), both per solid angle. The density of a sampled direction is positive.
        radiance *= power_heuristic(met.explicit_pdf_w / get_pdf_w(paths, slot), settings.beta);
    }
#endif
    set_radiance(paths, slot, get_radiance(paths, slot) + radiance);
}

__kernel void evaluate_emission(SURFACE_PARAMETERS LIGHT_PARAMETERS IntegratorSettings settings, STREAM_PARAMETERS) {
    const PathStates paths = {path_words, capacity};
    FOR_EACH_ENTRY(i, active_count(counters)) {
        add_emission(paths, active_slot(queues, counters, capacity, i), SURFACE_ARGUMENTS LIGHT_ARGUMENTS settings);
    }
}
