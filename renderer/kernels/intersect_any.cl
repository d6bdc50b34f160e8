// SPDX-License-Identifier: MIT
// Stage intersect_any: traces the shadow rays of camera paths and adds the connections that nothing
// blocks.
//
// STAGE(intersect_any,
//       reads(shadow, ray_origin, radiance, shadow_origin, shadow_vector, shadow_radiance, trials),
//       writes(radiance, trials))

#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/path/shadow_ray.h"
#include "renderer/kernels/stream.h"

__kernel void intersect_any(TRACING_PARAMETERS, STREAM_PARAMETERS) {
    const SceneView scene = TRACING_VIEW;
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, shadow_count(stream)) {
        add_unblocked(path_at(stream, shadow_queue(stream), i, i_end), &scene);
    }
}
