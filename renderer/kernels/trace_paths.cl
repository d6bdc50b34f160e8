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

__kernel void trace_paths(SCENE_PARAMETERS, CameraRecord camera, GLOBAL long *film_words,
                          GLOBAL long *half_film_words, IntegratorSettings settings,
                          ulong first_sample, uint first_work, uint work,
                          GLOBAL const uint *live_pixels, uint live_count,
                          GLOBAL StreamCounters *counters) {
    const SceneView scene = SCENE_VIEW;
    uint words[PATH_STATE_WORDS];
    const PathStates paths = {words, 1u};
    const FilmView film = {film_words, half_film_words, counters};
    const LivePixels live = make_live_pixels(live_pixels, live_count, camera.width * camera.height);
    RayCounts rays = {0u, 0u};
    FOR_EACH_ENTRY(i, work - first_work) {
        start_item(paths, 0u, camera, settings, first_sample, live, first_work + i, work);
        while (advance_path(paths, &scene, camera, film, settings, first_sample, &rays)) {
        }
        end_path(paths, 0u, film, first_sample);
    }
    count_rays(counters, rays);
}
