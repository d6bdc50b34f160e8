// SPDX-License-Identifier: MIT
// Stage trace_paths: path tracing in a single kernel ("megakernel").
//
// Each work-item traces paths of the batch one after the other, each from the camera to its end. In
// the comparison of the thesis (section 4.4.3, figure 4.22) it replaces OptiX 3.0, which built such
// kernels. The difference between it and the wavefront shows what streams between stages cost and
// gain.
//
// Writes: film; ray counts.

#include "renderer/kernels/advance_path.h"
#include "renderer/kernels/generate_camera_rays.cl"

__kernel void trace_paths(TRAVERSAL_PARAMETERS SURFACE_PARAMETERS MATERIAL_PARAMETERS
                              LIGHT_PARAMETERS CameraRecord camera,
                          GLOBAL long *film, HALF_FILM_PARAMETERS IntegratorSettings settings,
                          ulong first_sample, uint first_work, uint work,
                          LIVE_PIXELS_PARAMETERS GLOBAL StreamCounters *counters) {
    uint words[PATH_STATE_WORDS];
    const PathStates paths = {words, 1u};
    RayCounts rays = {0u, 0u};
    FOR_EACH_ENTRY(i, work - first_work) {
        start_item(paths, 0u, camera, settings, first_sample, LIVE_PIXELS_ARGUMENTS first_work + i,
                   work);
        while (advance_path(
            paths, TRAVERSAL_ARGUMENTS SURFACE_ARGUMENTS MATERIAL_ARGUMENTS LIGHT_ARGUMENTS camera,
            film, settings, first_sample, &rays, counters)) {
        }
        end_path(paths, 0u, film, HALF_FILM_ARGUMENTS first_sample, counters);
    }
    count_rays(counters, rays);
}
