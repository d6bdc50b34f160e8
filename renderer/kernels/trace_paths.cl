// SPDX-License-Identifier: MIT
// Stage trace_paths: path tracing in a single kernel ("megakernel").
//
// Each work-item traces paths of the batch one after the other, each from the camera to its end. In
// the comparison of the thesis (section 4.4.3, figure 4.22) it replaces OptiX 3.0, which built such
// kernels. The difference between it and the wavefront shows what streams between stages cost and
// gain.
//
// STAGE(trace_paths,
//       reads(live_pixels),
//       writes(film, half_film, counters))

#define PATH_STATES_PRIVATE 1

#include "renderer/kernels/path/advance.h"
#include "renderer/kernels/path/camera_start.h"
#include "renderer/kernels/path/retire.h"
#include "renderer/kernels/stream.h"

__kernel void trace_paths(SCENE_PARAMETERS, CameraRecord camera, GLOBAL long *film_words,
                          GLOBAL long *half_film_words, IntegratorSettings settings,
                          ulong first_sample, uint first_work, uint work,
                          GLOBAL const uint *live_pixels, uint live_count,
                          GLOBAL StreamCounters *counters) {
    const SceneView scene = SCENE_VIEW;
    const FilmView film = {film_words, counters, first_sample};
    const LivePixels live = make_live_pixels(live_pixels, live_count, camera.width * camera.height);
    uint words[PATH_STATE_WORDS];
    const Path path = {words, 1u, 0u};
    RayCounts rays = {0u, 0u};
    FOR_EACH_ENTRY(i, work - first_work) {
        const uint item = first_work + i;
        const CameraItem of = camera_item(live, item, work);
        start_camera_path(path, camera, item, of,
                          path_sample(settings, of.pixel, first_sample + of.sample, BLOCK_CAMERA));
        while (advance_path(path, &scene, camera, film, settings, first_sample, &rays)) {
        }
        retire_path(path, film, half_film_words);
    }
    count_rays(counters, rays);
}
