// SPDX-License-Identifier: MIT
// Stage connect_vertices: connects the hit of each camera path to vertex `vertex_index` of the
// light path with the same index.
//
// STAGE(connect_vertices,
//       reads(active, hit, pixel, sample, depth, ray_direction, throughput, log_inverse_arrival,
//             log_strategies, vertices),
//       writes(ray_origin, shadow_origin, shadow_vector, shadow_radiance),
//       to(shadow))

#include "renderer/kernels/path/hit_path_at.h"
#include "renderer/kernels/path/vertex_connection.h"
#include "renderer/kernels/stream.h"

__kernel void connect_vertices(SHADING_PARAMETERS, IntegratorSettings settings, uint vertex_index,
                               GLOBAL uint *vertex_words, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    PushBuffer shadow;
    shadow.count = 0u;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        const Path path = shaded_path_at(&scene, stream, i, i_end);
        if (connect_to_vertex(path, &scene, vertex_words, settings, vertex_index)) {
            push_slot(&shadow, path.slot);
        }
    }
    append_shadow(stream, &shadow);
}
