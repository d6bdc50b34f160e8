// SPDX-License-Identifier: MIT
// Stage generate_light_paths: starts a light path in every free slot while light paths of the batch
// are left.
//
// Reads: free queue.
// Writes: path states; light vertices (clears the path's row).
// Enqueues: active queue of this round.

#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/light/start.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/path_state.h"

/// Starts light path `path` of sample `sample` of the batch.
DEVICE void start_path(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                       IntegratorSettings settings, ulong first_sample, uint path, uint sample) {
    set_pixel(paths, slot, path);
    set_sample(paths, slot, sample);
    set_depth(paths, slot, 0u);
    const EmissionSample emission = path_start(scene, settings, path, first_sample + sample);
    set_ray_origin(paths, slot, emission.origin);
    set_ray_direction(paths, slot, emission.direction);
    set_throughput(paths, slot, emission.weight);
    set_roulette_scale(paths, slot,
                       max(emission.weight.x, max(emission.weight.y, emission.weight.z)));
    set_light(paths, slot, emission.light);
    // Surfaces emit in proportion to the cosine, so p_d per projected solid angle is 1 / pi there.
    // A delta light cannot be hit by an implicit path.
    const float p_d = emission.at_infinity != 0u ? emission.pdf_direction : INV_PI;
    const float log_ratio =
        emission.is_delta != 0u ? -INFINITY : log2_quotient(1.0f / p_d, emission.pdf_origin);
    set_log_ratio(paths, slot, log_ratio);
    set_log_strategies(paths, slot, log_ratio);
    // At the first hit, its distance and cosine complete this factor.
    set_log_arrival(paths, slot, log2_quotient(1.0f, emission.pdf_direction));
}

__kernel void generate_light_paths(SHADING_PARAMETERS, IntegratorSettings settings,
                                   ulong first_sample, uint work, GLOBAL uint *vertex_words,
                                   STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    const WorkItems items = take_work(counters);
    PushBuffer started;
    started.count = 0u;
    for (uint i = 0; i < items.count && items.first + i < work; ++i) {
        const uint slot = queues[QUEUE_FREE * capacity + items.slots + i];
        start_path(paths, slot, &scene, settings, first_sample,
                   (items.first + i) % settings.light_paths,
                   (items.first + i) / settings.light_paths);
        for (uint vertex = 0; FEATURE_vertex_joins && vertex < settings.light_vertices; ++vertex) {
            clear_light_vertex(light_vertex_place(vertex_words, capacity, settings.light_vertices,
                                                  (items.first + i) % capacity, vertex));
        }
        push_slot(&started, slot);
    }
    append_active(queues, counters, capacity, counters->parity, &started);
}
