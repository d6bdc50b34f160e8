// SPDX-License-Identifier: MIT
// Stage evaluate_emission: adds the light that the hit of each active path, or the light at
// infinity, emits towards it. This covers emitters seen directly and implicit paths.
//
// STAGE(evaluate_emission,
//       reads(active, hit, depth, ray_origin, ray_direction, throughput, radiance, pdf_w,
//             log_running_ratio, log_strategies, trials),
//       writes(radiance, log_running_ratio, log_inverse_arrival, trials))

#include "renderer/kernels/path/emission_hit.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/stream.h"

__kernel void evaluate_emission(SHADING_PARAMETERS, IntegratorSettings settings,
                                STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        add_emission(path_at(stream, active_queue(stream), i, i_end), &scene, settings);
    }
}
