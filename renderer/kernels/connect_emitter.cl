// SPDX-License-Identifier: MIT
// Stage connect_emitter: connects the start of each new light path to the camera, for emitters that
// the camera sees directly.
//
// STAGE(connect_emitter,
//       reads(active, pixel, sample, depth),
//       writes(shadow_origin, shadow_vector, shadow_radiance, splat_pixel, trials),
//       to(shadow))

#include "renderer/kernels/path/camera_connection.h"
#include "renderer/kernels/path/path_at.h"
#include "renderer/kernels/stream.h"

__kernel void connect_emitter(SHADING_PARAMETERS, CameraRecord camera, IntegratorSettings settings,
                              ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const Stream stream = STREAM_VIEW;
    PushBuffer shadow;
    shadow.count = 0u;
    FOR_EACH_ENTRY(i, active_count(stream)) {
        const Path path = path_at(stream, active_queue(stream), i, i_end);
        if (connect_start_to_camera(path, &scene, camera, settings, first_sample)) {
            push_slot(&shadow, path.slot);
        }
    }
    append_shadow(stream, &shadow);
}
