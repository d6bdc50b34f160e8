// SPDX-License-Identifier: MIT
// One event of a path, for kernels in which a work-item follows a path on its own (trace_paths.cl,
// finish_paths.cl).
//
// It calls the functions of the wavefront stages in the order of a round, so the image has the same
// bits. The path is in the work-item's private memory.
#pragma once

#define PATH_STATES_PRIVATE 1

#include "renderer/kernels/connect_camera.cl"
#include "renderer/kernels/evaluate_emission.cl"
#include "renderer/kernels/extend_path.cl"
#include "renderer/kernels/intersect_any.cl"
#include "renderer/kernels/intersect_nearest.cl"
#include "renderer/kernels/sample_light.cl"
#include "renderer/kernels/splat_unblocked.cl"

/// Numbers of rays that a work-item traced.
typedef struct RayCounts {
    uint nearest;
    uint shadow;
} RayCounts;

/// Adds the rays of a work-item to the stream's counters.
DEVICE void count_rays(GLOBAL StreamCounters *counters, RayCounts rays) {
    if (rays.nearest > 0u) {
        film_add_word((volatile GLOBAL long *)&counters->nearest_rays, rays.nearest);
        film_add_word((volatile GLOBAL long *)&counters->shadow_rays, rays.shadow);
    }
}

/// Connects the path's hit to one light, or to each light with FEATURE_independent_lights, and adds
/// unblocked light samples to the path.
DEVICE void add_light_samples(PathStates paths, PRIVATE const SceneView *scene,
                              IntegratorSettings settings, ulong first_sample,
                              PRIVATE RayCounts *rays) {
    const uint count = FEATURE_independent_lights ? scene->lighting.light_count : 1u;
    for (uint light = 0u; light < count; ++light) {
        const uint chosen = FEATURE_independent_lights ? light : SELECT_LIGHT;
        if (join_to_light(paths, 0u, scene, settings, first_sample, chosen)) {
            add_unblocked(paths, 0u, scene, get_ray_origin(paths, 0u),
                          get_shadow_vector(paths, 0u));
            ++rays->shadow;
        }
    }
}

/// Advances the path in slot 0 by one event. Returns false if the path ends there. The connection
/// of a light path's start to the camera is not part of it.
DEVICE bool advance_path(PathStates paths, PRIVATE const SceneView *scene, CameraRecord camera,
                         FilmView film, IntegratorSettings settings, ulong first_sample,
                         PRIVATE RayCounts *rays) {
    find_hit(paths, 0u, scene, get_ray_origin(paths, 0u), get_ray_direction(paths, 0u));
    ++rays->nearest;
    const bool meets_light = FEATURE_area_lights || FEATURE_shape_lights ||
                             FEATURE_infinite_lights || FEATURE_light_strategy;
    if (FEATURE_from_camera && meets_light) {
        add_emission(paths, 0u, scene, settings);
    }
    if (FEATURE_from_camera && FEATURE_explicit_light) {
        add_light_samples(paths, scene, settings, first_sample, rays);
    }
    if (FEATURE_from_light && join_hit(paths, 0u, scene, camera, settings, first_sample)) {
        splat(paths, 0u, scene, film);
        ++rays->shadow;
    }
    return scatter(paths, 0u, scene, settings, first_sample);
}
