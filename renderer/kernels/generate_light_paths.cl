// SPDX-License-Identifier: MIT
// Stage generate_light_paths: starts a light path in every free slot while light paths of the batch
// are left, and clears its stored vertices.
//
// STAGE(generate_light_paths,
//       reads(free, pixel, sample),
//       writes(pixel, sample, depth, ray_origin, ray_direction, throughput, roulette_scale,
//              log_running_ratio, log_inverse_arrival, log_strategies, light, vertices, trials),
//       to(active))

#include "renderer/kernels/path/light_start.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/path/stored_vertex.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/stream.h"

__kernel void generate_light_paths(SHADING_PARAMETERS, IntegratorSettings settings,
                                   ulong first_sample, uint work, GLOBAL uint *vertex_words,
                                   STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    const WorkItems items = take_work(stream);
    PushBuffer started;
    started.count = 0u;
    for (uint i = 0; i < items.count && items.first + i < work; ++i) {
        const Path path = path_in(stream, queue_entries(stream, QUEUE_FREE)[items.slots + i]);
        const uint item = items.first + i;
        start_light_path(path, &scene, settings, first_sample, item % settings.light_paths,
                         item / settings.light_paths);
        clear_vertices(path, vertex_words, settings);
        if (FEATURE_light_path_trials) {
            start_trials(path, item);
        }
        push_slot(&started, path.slot);
    }
    append_started(stream, &started);
}
