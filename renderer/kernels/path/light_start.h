// SPDX-License-Identifier: MIT
// The start of a light path.
#pragma once

#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/sampling/sampler.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns the start of light path `index` of sample `sample`.
DEVICE EmissionSample light_path_start(PRIVATE const SceneView *scene, IntegratorSettings settings,
                                       uint index, ulong sample) {
    return sample_emission(scene, path_sample(settings, index, sample, BLOCK_EMISSION(0u)),
                           path_sample(settings, index, sample, BLOCK_EMISSION(1u)));
}

/// Returns the start that light path `index` of sample `sample` shows to the camera. No table
/// guides it: light paths with k = 1 have no direction, and p_o of MIS (17) is uniform by area.
DEVICE EmissionSample seen_light_path_start(PRIVATE const SceneView *scene,
                                            IntegratorSettings settings, uint index, ulong sample) {
    return sample_seen_emission(scene, path_sample(settings, index, sample, BLOCK_EMISSION(0u)),
                                path_sample(settings, index, sample, BLOCK_EMISSION(1u)));
}

/// Starts light path `item` of the batch, all paths of one sample after the other. Returns its
/// start.
DEVICE EmissionSample start_light_path(Path path, PRIVATE const SceneView *scene,
                                       IntegratorSettings settings, ulong first_sample, uint item) {
    const uint index = item % settings.light_paths, sample = item / settings.light_paths;
    const EmissionSample emission = light_path_start(scene, settings, index, first_sample + sample);
    set_pixel(path, index);
    set_sample(path, sample);
    set_depth(path, 0u);
    set_ray_origin(path, emission.origin);
    set_ray_direction(path, emission.direction);
    set_throughput(path, emission.weight);
    set_roulette_scale(path, max(emission.weight.x, max(emission.weight.y, emission.weight.z)));
    set_light(path, emission.light);
    // Surfaces emit in proportion to the cosine, so p_d per projected solid angle is g / pi there.
    // A delta light cannot be hit by an implicit path.
    const float p_d = emission.at_infinity != 0u ? emission.pdf_direction : emission.guide * INV_PI;
    const float log_s =
        emission.is_delta != 0u ? -INFINITY : log2_quotient(1.0f / p_d, emission.pdf_origin);
    set_log_running_ratio(path, log_s);  // begins Q of MIS (15)
    set_trial_ratio(path, log_s);
    set_log_strategies(path, log_s);  // S_k of MIS (20)
    // A_{k-1} of MIS (20) without the distance and the cosine of the first hit, and without p_oe
    // and p_o. `set_light_path_arrival` completes it.
    set_log_inverse_arrival(path, log2_quotient(1.0f, emission.pdf_direction));
    return emission;
}
