// SPDX-License-Identifier: MIT
// The start of a light path.
#pragma once

#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/math/logarithm.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/sampling/word_batch.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns the start that light path `index` of sample `sample` shows to the camera. No table
/// guides it: light paths with k = 1 have no direction, and p_o of MIS (17) is uniform by area.
DEVICE EmissionSample seen_light_path_start(PRIVATE const SceneView *scene,
                                            IntegratorSettings settings, uint index, ulong sample) {
    return sample_seen_emission(scene, path_sample(settings, index, sample, BLOCK_EMISSION(0u)),
                                path_sample(settings, index, sample, BLOCK_EMISSION(1u)));
}

/// Words of the starts of light paths: those of BLOCK_EMISSION(0u) and BLOCK_EMISSION(1u).
typedef struct EmissionWords {
    WordRequests requests;
    WordBatch first, second;
} EmissionWords;

/// Draws the words of the light paths from item `item` of the batch on, all paths of one sample
/// after the other.
DEVICE void draw_emission_words(PRIVATE EmissionWords *words, IntegratorSettings settings,
                                ulong first_sample, uint item) {
    PRIVATE WordRequests *requests = &words->requests;
    for (uint i = 0u; i < WORD_BATCH; ++i) {
        requests->pixel[i] = (item + i) % settings.light_paths;
        requests->sample[i] = (item + i) / settings.light_paths;
        requests->block[i] = BLOCK_EMISSION(0u);
    }
    draw_words(&words->first, requests, settings, STREAM_LIGHT_PATHS, first_sample);
    for (uint i = 0u; i < WORD_BATCH; ++i) {
        requests->block[i] = BLOCK_EMISSION(1u);
    }
    draw_words(&words->second, requests, settings, STREAM_LIGHT_PATHS, first_sample);
}

/// Starts path i of the work-item, whose first one is item `first` of the batch, and returns its
/// start. Draws the words of the next paths with those of this one.
DEVICE EmissionSample start_light_path(Path path, PRIVATE const SceneView *scene,
                                       PRIVATE EmissionWords *words, IntegratorSettings settings,
                                       ulong first_sample, uint first, uint i) {
    const uint place = i % WORD_BATCH;
    if (place == 0u) {
        draw_emission_words(words, settings, first_sample, first + i);
    }
    const uint index = words->requests.pixel[place], sample = words->requests.sample[place];
    const EmissionSample emission =
        sample_emission(scene, words_in(&words->first, place), words_in(&words->second, place));
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
    if (FEATURE_light_path_trials) {
        start_light_trials(path, scene, emission, first + i);
    }
    return emission;
}
