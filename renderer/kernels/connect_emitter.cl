// SPDX-License-Identifier: MIT
// Stage connect_emitter: connects the start of each new light path to the camera, for emitters that
// the camera sees directly.
//
// The origin of the shadow ray is that of the path, so ray_origin is not written.
//
// Reads: depth, pixel, sample, active queue.
// Writes: shadow_vector, shadow_radiance, splat_pixel.
// Enqueues: shadow queue.

#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/light/start.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/kernels/stream.h"
#include "renderer/shared/path_state.h"

/// Connects the start of a light path to the camera and prepares the shadow ray. Returns false if
/// the camera does not see it or light paths do not show it.
DEVICE bool join_start(PathStates paths, uint slot, PRIVATE const SceneView *scene,
                       CameraRecord camera, IntegratorSettings settings, ulong first_sample) {
    const uint path = get_pixel(paths, slot);
    const ulong sample = first_sample + get_sample(paths, slot);
    const bool seen_by_camera_alone =
        FEATURE_light_strategy &&
        (settings.strategies & (STRATEGY_LIGHT | STRATEGY_LIGHT_EMITTERS)) == STRATEGY_LIGHT;
    if (get_depth(paths, slot) > 0u || seen_by_camera_alone) {
        return false;
    }
    const EmissionSample start = path_start(scene, settings, path, sample);
    if (start.is_delta != 0u || start.at_infinity != 0u) {
        return false;
    }
    const uint4 words = path_sample(settings, path, sample, BLOCK_CAMERA);
    const CameraJoin join =
        join_camera(camera, start.point.position, uniform_float(words.x), uniform_float(words.y));
    const float3 way = join.lens_point - start.point.position;
    const float squared = dot(way, way);
    const float facing = dot(start.point.normal, way);  // cosine times distance
    if (!(join.pdf_w > 0.0f && facing > 0.0f)) {
        return false;
    }
    // P_1, the density of camera paths per area at the start. The path contributes L P_1 / (p_o
    // n_L).
    const float camera_pdf_a = join.pdf_w * (facing / sqrt(squared)) / squared;
    const float light_pdf_a = start.pdf_origin * (float)settings.light_paths;  // p_o n_L
    float3 radiance = light_radiance(scene->lights[start.light]) * (camera_pdf_a / light_pdf_a);
    if (FEATURE_light_emitters && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        // p_I / p_L = P_1 / (n_L p_o) of a path with one edge (light/mis.h).
        radiance *=
            camera_path_weight(0.0f, log2_quotient(camera_pdf_a, light_pdf_a), settings.beta);
    }
    set_shadow_vector(paths, slot, join.lens_point - start.origin);
    set_shadow_radiance(paths, slot, radiance);
    set_splat_pixel(paths, slot, (uint)join.raster.y * camera.width + (uint)join.raster.x);
    return true;
}

__kernel void connect_emitter(SHADING_PARAMETERS, CameraRecord camera, IntegratorSettings settings,
                              ulong first_sample, STREAM_PARAMETERS) {
    const SceneView scene = SHADING_VIEW;
    const PathStates paths = {path_words, capacity};
    PushBuffer shadow;
    shadow.count = 0u;
    FOR_EACH_ENTRY(i, active_count(counters)) {
        const uint slot = path_at(paths, active_queue(queues, counters, capacity), i, i_end);
        if (join_start(paths, slot, &scene, camera, settings, first_sample)) {
            push_slot(&shadow, slot);
        }
    }
    append_slots(queues, QUEUE_SHADOW, capacity, &counters->shadow, counters, &shadow);
}
