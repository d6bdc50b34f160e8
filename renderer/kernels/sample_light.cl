// SPDX-License-Identifier: MIT
// Stage sample_light: connects the hit of each active path to a point sampled on a light (explicit
// paths).
//
// STAGE(sample_light,
//       reads(active, hit, pixel, sample, depth, ray_direction, throughput, log_running_ratio,
//             log_inverse_arrival, log_strategies),
//       writes(ray_origin, shadow_origin, shadow_vector, shadow_radiance, trials),
//       to(shadow))

#include "renderer/kernels/path/hit_path_at.h"
#include "renderer/kernels/path/light_sample.h"
#include "renderer/kernels/path/words_at.h"
#include "renderer/kernels/stream.h"

__kernel void sample_light(SHADING_PARAMETERS, IntegratorSettings settings, ulong first_sample,
                           uint light_index, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    WordBatch words;
    PushBuffer shadow;
    shadow.count = 0u;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        const Path path = shaded_path_at(&scene, stream, i, i_end);
        const uint4 of_path =
            light_words_at(&words, stream, i, i_end, settings, first_sample, light_index);
        if (connect_to_light(path, &scene, settings, of_path, light_index)) {
            push_slot(&shadow, path.slot);
        }
    }
    append_shadow(stream, &shadow);
}
