// SPDX-License-Identifier: MIT
// What a path contributes in every trial of a pilot (shared/light_path_trials.h). Without
// FEATURE_light_path_trials nothing here is called.
#pragma once

#include "renderer/kernels/bsdf/guided_scattering.h"
#include "renderer/kernels/light/emission.h"
#include "renderer/kernels/mis/truncated.h"
#include "renderer/kernels/texture/texture.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/light_path_trials.h"
#include "renderer/shared/path_state.h"

/// Starts the trials of path `item` of the work.
DEVICE void start_trials(Path path, uint item) {
    set_trial_item(path, item);
    set_trial_start(path, 0u);
    set_trial_density(path, 0.0f);
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        set_trial_value(path, trial, 0.0f);
    }
}

/// Starts the trials of a light path. Under a guide, stores the bin of its start and the density.
DEVICE void start_light_trials(Path path, PRIVATE const SceneView *scene, EmissionSample start,
                               uint item) {
    start_trials(path, item);
    if (FEATURE_guided_emission) {
        const LightRecord light = light_at(scene, start.light);
        uint place = start.light * GUIDE_BINS;
        if (has_guide_table(light)) {
            const GuideBin bin = guide_bin(light, start.direction);
            place += bin.row * GUIDE_COLUMNS + bin.column;
        }
        set_trial_start(path, place);
        set_trial_density(path, light.emission_selection * start.guide);
    }
}

/// Returns the weight of an implicit or explicit path in a trial, MIS (13), from what
/// `camera_path_weight` has for the light paths that are traced. Without light paths it is MIS (8).
DEVICE float camera_trial_weight(uint trial, float other_over_own, float log_light_over_own,
                                 float beta) {
    return trial_has_light_paths(trial)
               ? camera_path_weight(other_over_own, log_light_over_own + trial_log_factor(trial),
                                    beta)
               : power_heuristic(other_over_own, beta);
}

/// Adds emission to a camera path in every trial. `radiance` has no weight yet.
DEVICE void add_emission_trials(Path path, float3 radiance, float by_explicit, float log_light,
                                float beta) {
    const float value = rec709_luminance(radiance);
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        const float other = trial_is_explicit(trial) ? by_explicit : 0.0f;
        set_trial_value(path, trial,
                        get_trial_value(path, trial) +
                            value * camera_trial_weight(trial, other, log_light, beta));
    }
}

/// Sets what a connection to a light adds in every trial. `radiance` has no weight yet.
DEVICE void set_light_sample_trials(Path path, float3 radiance, float by_implicit, float log_light,
                                    float beta) {
    const float value = rec709_luminance(radiance);
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        const float weight = trial_is_explicit(trial)
                                 ? camera_trial_weight(trial, by_implicit, log_light, beta)
                                 : 0.0f;
        set_shadow_trial(path, trial, value * weight);
    }
}

/// Adds an unblocked connection of a camera path to a light.
DEVICE void add_light_sample_trials(Path path) {
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        set_trial_value(path, trial, get_trial_value(path, trial) + get_shadow_trial(path, trial));
    }
}

/// Adds an unblocked connection of a light path to the camera. Its pixel is that of no other
/// connection of the path, as a rule, so the squares add up to the second moment. Its root is kept,
/// because squares may overflow or vanish.
DEVICE void add_splat_trials(Path path) {
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        const float found = get_trial_value(path, trial), added = get_shadow_trial(path, trial);
        const float greater = fmax(found, added);
        const float ratio = greater > 0.0f ? fmin(found, added) / greater : 0.0f;
        set_trial_value(path, trial, greater * sqrt(fma(ratio, ratio, 1.0f)));
    }
}

/// Stores the hit of a light path that may train a scatter guide. `list` has the trials of all
/// paths.
DEVICE void store_training_hit(Path path, PRIVATE const SceneView *scene,
                               IntegratorSettings settings, GLOBAL PathTrials *list) {
    const uint depth = get_depth(path), primitive = get_hit_primitive(path);
    if (settings.training_paths == 0u || depth == 0u || depth > TRAINING_HITS ||
        primitive == NO_HIT) {
        return;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(path));
    if ((scene->materials[hit.material].flags & MATERIAL_GUIDED) == 0u) {
        return;
    }
    const float3 from = -get_ray_direction(path);
    const float3 normal = hit.point.normal;
    const GuideBin bin = sphere_bin(from);
    GLOBAL TrainingHit *hits = (GLOBAL TrainingHit *)(list + settings.training_paths);
    GLOBAL TrainingHit *stored = hits + get_trial_item(path) * TRAINING_HITS + (depth - 1u);
    stored->position[0] = hit.point.position.x;
    stored->position[1] = hit.point.position.y;
    stored->position[2] = hit.point.position.z;
    stored->power = rec709_luminance(get_throughput(path));
    stored->side = guide_side(dot(normal, from) < 0.0f ? -normal : normal);
    stored->bin = bin.row * GUIDE_COLUMNS + bin.column;
}

/// Writes what a path found to the list of all paths.
DEVICE void store_trials(Path path, GLOBAL PathTrials *list) {
    GLOBAL PathTrials *found = list + get_trial_item(path);
    for (uint trial = 0u; trial < LIGHT_PATH_TRIALS; ++trial) {
        found->value[trial] = get_trial_value(path, trial);
    }
    found->start = get_trial_start(path);
    found->start_density = get_trial_density(path);
}
