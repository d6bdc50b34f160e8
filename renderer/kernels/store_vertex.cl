// SPDX-License-Identifier: MIT
// Stage store_vertex: stores the hit of each light path if camera paths can be connected to it.
//
// STAGE(store_vertex,
//       reads(active, hit, pixel, sample, depth, ray_direction, throughput, log_inverse_arrival,
//             log_strategies),
//       writes(vertices))

#include "renderer/kernels/path/hit_path_at.h"
#include "renderer/kernels/path/stored_vertex.h"
#include "renderer/kernels/stream.h"

__kernel void store_vertex(SHADING_PARAMETERS, IntegratorSettings settings,
                           GLOBAL uint *vertex_words, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        store_hit(hit_path_at(&scene, stream, i, i_end), &scene, vertex_words, settings);
    }
}
