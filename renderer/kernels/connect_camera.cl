// SPDX-License-Identifier: MIT
// Stage connect_camera: connects the hit of each light path to a point on the lens (light paths of
// the thesis, section 2.8).
//
// STAGE(connect_camera,
//       reads(active, hit, pixel, sample, depth, ray_origin, ray_direction, throughput, pdf_w,
//             log_running_ratio, log_inverse_arrival, log_strategies, light, trials),
//       writes(ray_origin, log_inverse_arrival, shadow_origin, shadow_vector, shadow_radiance,
//              splat_pixel, trials),
//       to(shadow))

#include "renderer/kernels/path/camera_connection.h"
#include "renderer/kernels/path/hit_path_at.h"
#include "renderer/kernels/stream.h"

__kernel void connect_camera(SHADING_PARAMETERS, CameraRecord camera, IntegratorSettings settings,
                             ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    PushBuffer shadow;
    shadow.count = 0u;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        const Path path = shaded_path_at(&scene, stream, i, i_end);
        if (connect_hit_to_camera(path, &scene, camera, settings, first_sample)) {
            push_slot(&shadow, path.slot);
        }
    }
    append_shadow(stream, &shadow);
}
