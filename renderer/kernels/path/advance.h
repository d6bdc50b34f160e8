// SPDX-License-Identifier: MIT
// One event of a path, for kernels in which a work-item follows a path on its own (trace_paths.cl,
// run_tail.cl).
//
// It calls the functions of the wavefront stages in the order of a round, so the image has the same
// bits. The path is in the work-item's private memory: the kernel's file defines
// PATH_STATES_PRIVATE as 1.
#pragma once

#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/path/camera_connection.h"
#include "renderer/kernels/path/emission_hit.h"
#include "renderer/kernels/path/light_sample.h"
#include "renderer/kernels/path/nearest_hit.h"
#include "renderer/kernels/path/scatter.h"
#include "renderer/kernels/path/shadow_ray.h"
#include "renderer/kernels/path/splat.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

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
DEVICE void add_light_samples(Path path, PRIVATE const SceneView *scene,
                              IntegratorSettings settings, ulong first_sample,
                              PRIVATE RayCounts *rays) {
    const uint count = FEATURE_independent_lights ? scene->lighting.light_count : 1u;
    for (uint light = 0u; light < count; ++light) {
        const uint light_index = FEATURE_independent_lights ? light : SELECT_LIGHT;
        const WordSource source = camera_source(settings, light_stream(light_index),
                                                get_pixel(path), first_sample + get_sample(path));
        if (connect_to_light(path, scene, settings,
                             words_of(settings, source, BLOCK_LIGHT(get_depth(path))),
                             light_index)) {
            add_unblocked(path, scene);
            ++rays->shadow;
        }
    }
}

/// Advances a path by one event. Returns false if the path ends there. The connection of a light
/// path's start to the camera is not part of it.
DEVICE bool advance_path(Path path, PRIVATE const SceneView *scene, CameraRecord camera,
                         FilmView film, IntegratorSettings settings, ulong first_sample,
                         PRIVATE RayCounts *rays) {
    const bool meets_light = FEATURE_area_lights || FEATURE_shape_lights ||
                             FEATURE_infinite_lights || FEATURE_light_strategy;
    find_hit(path, scene);
    ++rays->nearest;
    if (FEATURE_from_camera && meets_light) {
        add_emission(path, scene, settings);
    }
    if (FEATURE_from_camera && FEATURE_explicit_light) {
        add_light_samples(path, scene, settings, first_sample, rays);
    }
    if (FEATURE_from_light && connect_hit_to_camera(path, scene, camera, settings, first_sample)) {
        splat(path, scene, film);
        ++rays->shadow;
    }
    return extend(path, scene, settings, film,
                  path_sample(settings, get_pixel(path), first_sample + get_sample(path),
                              BLOCK_SCATTER(get_depth(path))));
}
