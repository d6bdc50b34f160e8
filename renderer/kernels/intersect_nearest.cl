// SPDX-License-Identifier: MIT
// Stage intersect_nearest: finds the nearest hits of the rays of the active paths.
//
// STAGE(intersect_nearest,
//       reads(active, ray_origin, ray_direction),
//       writes(hit))

#include "renderer/kernels/path/nearest_hit.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/stream.h"

__kernel void intersect_nearest(TRACING_PARAMETERS, STREAM_PARAMETERS) {
    const SceneView scene = TRACING_VIEW;
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        find_hit(path_at(stream, active_queue(stream), i, i_end), &scene);
    }
}
