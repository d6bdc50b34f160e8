// SPDX-License-Identifier: MIT
// Stage generate_light_paths: starts a light path in every free slot while light paths of the batch
// are left, and clears its stored vertices. Where the camera may see an emitter directly, it
// connects the start to the camera.
//
// STAGE(generate_light_paths,
//       reads(free, pixel, sample),
//       writes(pixel, sample, depth, ray_origin, ray_direction, throughput, roulette_scale,
//              log_running_ratio, log_inverse_arrival, log_strategies, light, vertices, trials,
//              shadow_origin, shadow_vector, shadow_radiance, splat_pixel),
//       to(active, shadow))

#include "renderer/kernels/path/camera_connection.h"
#include "renderer/kernels/path/light_start.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/path/stored_vertex.h"
#include "renderer/kernels/stream.h"

__kernel void generate_light_paths(SHADING_PARAMETERS, CameraRecord camera,
                                   IntegratorSettings settings, ulong first_sample, uint work,
                                   GLOBAL uint *vertex_words, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    const WorkItems items = take_work(stream);
    EmissionWords words;
    PushBuffer started, shadow;
    started.count = 0u;
    shadow.count = 0u;
    for (uint i = 0; i < items.count && items.first + i < work; ++i) {
        const Path path = path_in(stream, queue_entries(stream, QUEUE_FREE)[items.slots + i]);
        const EmissionSample start =
            start_light_path(path, &scene, &words, settings, first_sample, items.first, i);
        clear_vertices(path, vertex_words, settings);
        push_slot(&started, path.slot);
        if (connect_start_to_camera(path, &scene, camera, settings, first_sample, start)) {
            push_slot(&shadow, path.slot);
        }
    }
    append_started(stream, &started);
    append_shadow(stream, &shadow);
}
