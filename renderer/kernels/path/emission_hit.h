// SPDX-License-Identifier: MIT
// Emission that a path hits: emitters seen directly and implicit paths.
#pragma once

#include "renderer/kernels/light/light.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/mis/bidirectional.h"
#include "renderer/kernels/mis/truncated.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Emission that a path meets, with the densities of the other strategies that could have sampled
/// the path.
typedef struct Emission {
    float3 radiance;
    /// Density per solid angle with which light sampling at the previous vertex samples this
    /// direction.
    float explicit_pdf_w;
    /// p_o p_d, per area and projected solid angle; for emitters seen directly p_o, per area.
    float line_pdf;
} Emission;

/// Sets the emission of the light at infinity towards a path that left the scene. Returns false if
/// there is none.
DEVICE bool infinite_emission(Path path, PRIVATE const SceneView *scene, bool by_light_sampling,
                              bool by_light_path, PRIVATE Emission *met) {
    if (!FEATURE_infinite_lights || scene->lighting.infinite_light == NO_EMITTER) {
        return false;
    }
    const float3 direction = get_ray_direction(path);
    met->radiance = infinite_radiance(scene, direction);
    if (by_light_sampling) {
        met->explicit_pdf_w = scene->lights[scene->lighting.infinite_light].selection *
                              infinite_pdf_w(scene, direction);
    }
    if (FEATURE_light_strategy && by_light_path) {
        // Light at infinity that the camera sees directly is not connected to the camera.
        met->line_pdf =
            get_depth(path) > 0u ? infinite_line_pdf(scene, get_ray_origin(path), direction) : 0.0f;
    }
    return true;
}

/// Sets the emission of the surface that a path hit. Returns false if there is none.
DEVICE bool surface_emission(Path path, PRIVATE const SceneView *scene, bool by_light_sampling,
                             bool by_light_path, PRIVATE Emission *met) {
    if (!FEATURE_area_lights && !FEATURE_shape_lights) {
        return false;
    }
    const uint primitive = get_hit_primitive(path);
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(path));
    if (hit.emitter == NO_EMITTER || !(dot(hit.point.normal, get_ray_direction(path)) < 0.0f)) {
        return false;
    }
    const LightRecord light = light_at(scene, light_of_hit(scene, primitive, hit.emitter));
    met->radiance = surface_radiance(scene, light, hit.uv);
    if (by_light_sampling) {
        const float3 from = get_ray_origin(path);
        met->explicit_pdf_w = light_pdf_a(scene, light, primitive, hit.emitter, from, hit.point) *
                              solid_angle_per_area(hit.point.position - from, hit.point.normal);
    }
    if (FEATURE_light_strategy && by_light_path) {
        met->line_pdf =
            get_depth(path) > 0u
                ? emission_line_pdf(scene, light, primitive, hit.emitter, -get_ray_direction(path))
                : emission_pdf_a(scene, light, primitive, hit.emitter);
    }
    return true;
}

/// Returns false if nothing is emitted towards the path. Sets the density of light sampling if
/// `by_light_sampling`, and that of light paths if `by_light_path`.
DEVICE bool emission_met(Path path, PRIVATE const SceneView *scene, bool by_light_sampling,
                         bool by_light_path, PRIVATE Emission *met) {
    met->explicit_pdf_w = 0.0f;
    met->line_pdf = 0.0f;
    return get_hit_primitive(path) == NO_HIT
               ? infinite_emission(path, scene, by_light_sampling, by_light_path, met)
               : surface_emission(path, scene, by_light_sampling, by_light_path, met);
}

/// Sets R_0 of MIS (11) at the first hit of a camera path and, for vertex connections, A_i of
/// MIS (19) at every hit. At the first hit `pdf_w` is the density of the camera ray per solid
/// angle.
DEVICE void set_camera_path_arrival(Path path, PRIVATE const SceneView *scene,
                                    IntegratorSettings settings) {
    const uint primitive = get_hit_primitive(path);
    const bool first = get_depth(path) == 0u;
    float log_a = -INFINITY;
    if (primitive != NO_HIT) {
        const SurfacePoint hit = surface_hit(scene, primitive, get_hit_at(path)).point;
        const float3 to_hit = hit.position - get_ray_origin(path);
        float squared = dot(to_hit, to_hit);
        if (FEATURE_lens && first && scene->lighting.camera_start_distance > 0.0f) {
            const float distance = scene->lighting.camera_start_distance + sqrt(squared);
            squared = distance * distance;
        }
        if (FEATURE_orthographic && first && scene->lighting.orthographic_camera != 0u) {
            squared = 1.0f;  // the density is per area perpendicular to the ray
        }
        const float cosine = fabs(dot(hit.normal, get_ray_direction(path)));
        // R_0 = A_1 = n_L / P_1 with P_1 of MIS (6), and A_i = 1 / E_i.
        const float paths = first ? (float)settings.light_paths : 1.0f;
        log_a = log_inverse_pdf_a(get_pdf_w(path), cosine, paths * squared);
    }
    if (first) {
        set_log_running_ratio(path, log_a);
    }
    if (FEATURE_vertex_connections) {
        set_log_inverse_arrival(path, log_a);
    }
}

/// Adds emission to a path, with the MIS weight of the implicit strategy.
DEVICE void add_emission(Path path, PRIVATE const SceneView *scene, IntegratorSettings settings) {
    const uint depth = get_depth(path);
    bool by_light_sampling = false, by_light_path = false;
    if (FEATURE_light_strategy && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        if (FEATURE_vertex_connections || depth == 0u) {
            set_camera_path_arrival(path, scene, settings);
        }
        by_light_path = depth > 0u || (settings.strategies & STRATEGY_LIGHT_EMITTERS) != 0u;
    }
    if ((settings.strategies & STRATEGY_HITS_ELSEWHERE) != 0u) {
        return;
    }
    if (FEATURE_scattering && depth > 0u) {
        if (!FEATURE_direction_density) {
            return;
        }
        // Light sampling is impossible after a delta event. Only implicit paths find this light, so
        // they count whatever the strategy.
        if (get_pdf_w(path) < INFINITY) {
            if ((settings.strategies & STRATEGY_IMPLICIT) == 0u) {
                return;
            }
            by_light_sampling = (settings.strategies & STRATEGY_EXPLICIT) != 0u;
        }
    }
    Emission met;
    if (!emission_met(path, scene, by_light_sampling, by_light_path, &met)) {
        return;
    }
    float3 radiance = met.radiance;
    if (FEATURE_scattering) {
        radiance *= get_throughput(path);
    }
    // p_E / p_I of MIS (7), thesis (2.73), both per solid angle. The density of a sampled direction
    // is positive.
    const float by_explicit = by_light_sampling ? met.explicit_pdf_w / get_pdf_w(path) : 0.0f;
    float log_light = -INFINITY;
    if (FEATURE_light_strategy && by_light_path) {
        const bool all =
            FEATURE_vertex_connections && depth > 0u && all_strategies(settings, depth);
        // p_L / p_I of MIS (10), or of MIS (17) for k = 1. With light vertices, S instead of R is
        // the sum over all strategies with a light path.
        log_light =
            (all ? get_log_strategies(path) : get_log_running_ratio(path)) + log2_of(met.line_pdf);
    }
    if (FEATURE_light_path_trials) {
        // What the camera sees directly varies at edges only. Over Sobol points such a variance
        // falls with N^1.5, not N, so that a few samples overstate it. A trial leaves it out.
        if (depth > 0u || settings.sampler != SAMPLER_SOBOL) {
            add_emission_trials(path, radiance, by_explicit, log_light, settings.beta);
        }
        return;
    }
    if (FEATURE_light_strategy && by_light_path) {
        radiance *= camera_path_weight(by_explicit, log_light, settings.beta);  // MIS (13)
    } else if (by_light_sampling) {
        radiance *= power_heuristic(by_explicit, settings.beta);  // MIS (8)
    }
    set_radiance(path, get_radiance(path) + radiance);
}
