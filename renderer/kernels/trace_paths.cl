// SPDX-License-Identifier: MIT
// Stage trace_paths: path tracing in one kernel ("megakernel"). Each work-item traces paths of the batch one after the
// other, each from the camera to its end, by the functions of the stages of path_tracing_round and in their order, so that
// the image has the same bits. It stands in for OptiX 3.0 in the comparison of thesis 4.4.3 (figure 4.22), which built
// such kernels: what separates the two is what streams between stages cost and gain.
// Writes: film; ray counts.

#define PATH_STATES_PRIVATE 1

// A header is pasted where it is named first, so that must not be a block that is off: what more than one stage needs comes
// before the blocks of some features.
#include "renderer/kernels/generate_camera_rays.cl"
#include "renderer/kernels/intersect_nearest.cl"
#include "renderer/kernels/light/mis.h"

#include "renderer/kernels/extend_path.cl"
#if FEATURE_lights
#include "renderer/kernels/light/light.h"
#endif
#define MEETS_LIGHT \
    (FEATURE_area_lights || FEATURE_shape_lights || FEATURE_infinite_lights || FEATURE_light_strategy)
#if MEETS_LIGHT
#include "renderer/kernels/evaluate_emission.cl"
#endif
#if FEATURE_explicit_light
#include "renderer/kernels/intersect_any.cl"
#include "renderer/kernels/sample_light.cl"
#endif

/// Rays that a work-item traced.
typedef struct RayCounts {
    uint nearest;
    uint shadow;
} RayCounts;

#if FEATURE_explicit_light

/// Joins the path's hit to a light, or to each of them.
DEVICE void add_light_samples(PathStates paths, TRAVERSAL_PARAMETERS SURFACE_PARAMETERS MATERIAL_PARAMETERS LIGHT_PARAMETERS
                              IntegratorSettings settings, ulong first_sample, PRIVATE RayCounts *rays) {
    const uint count = FEATURE_independent_lights ? lighting.light_count : 1u;
    for (uint light = 0u; light < count; ++light) {
        const uint chosen = FEATURE_independent_lights ? light : SELECT_LIGHT;
        if (join_to_light(paths, 0u, SURFACE_ARGUMENTS MATERIAL_ARGUMENTS LIGHT_ARGUMENTS settings, first_sample, chosen)) {
            add_unblocked(paths, 0u, GEOMETRY_ARGUMENTS get_ray_origin(paths, 0u), get_shadow_vector(paths, 0u));
            ++rays->shadow;
        }
    }
}

#endif

/// Traces one path from its start, in slot 0, to its end.
DEVICE void trace_path(PathStates paths, TRAVERSAL_PARAMETERS SURFACE_PARAMETERS MATERIAL_PARAMETERS LIGHT_PARAMETERS
                       IntegratorSettings settings, ulong first_sample, PRIVATE RayCounts *rays) {
    bool goes_on = true;
    while (goes_on) {
        find_hit(paths, 0u, GEOMETRY_ARGUMENTS get_ray_origin(paths, 0u), get_ray_direction(paths, 0u));
        ++rays->nearest;
#if MEETS_LIGHT
        add_emission(paths, 0u, SURFACE_ARGUMENTS LIGHT_ARGUMENTS settings);
#endif
#if FEATURE_explicit_light
        add_light_samples(paths, TRAVERSAL_ARGUMENTS SURFACE_ARGUMENTS MATERIAL_ARGUMENTS LIGHT_ARGUMENTS settings,
                          first_sample, rays);
#endif
#if FEATURE_scattering
        goes_on = scatter(paths, 0u, SURFACE_ARGUMENTS MATERIAL_ARGUMENTS settings, first_sample);
#else
        goes_on = false;
#endif
    }
}

__kernel void trace_paths(TRAVERSAL_PARAMETERS SURFACE_PARAMETERS MATERIAL_PARAMETERS LIGHT_PARAMETERS CameraRecord camera,
                          GLOBAL long *film, HALF_FILM_PARAMETERS IntegratorSettings settings, ulong first_sample,
                          uint first_work, uint work, LIVE_PIXELS_PARAMETERS GLOBAL StreamCounters *counters) {
    uint words[PATH_STATE_WORDS];
    const PathStates paths = {words, 1u};
    RayCounts rays = {0u, 0u};
    FOR_EACH_ENTRY(i, work - first_work) {
        start_item(paths, 0u, camera, settings, first_sample, LIVE_PIXELS_ARGUMENTS first_work + i, work);
        trace_path(paths, TRAVERSAL_ARGUMENTS SURFACE_ARGUMENTS MATERIAL_ARGUMENTS LIGHT_ARGUMENTS settings, first_sample,
                   &rays);
        end_path(paths, 0u, film, HALF_FILM_ARGUMENTS first_sample, counters);
    }
    if (rays.nearest > 0u) {
        film_add_word((volatile GLOBAL long *)&counters->nearest_rays, rays.nearest);
        film_add_word((volatile GLOBAL long *)&counters->shadow_rays, rays.shadow);
    }
}
