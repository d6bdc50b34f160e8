// SPDX-License-Identifier: MIT
// Scattering: the next direction of a path, Russian roulette and the other ends of paths.
#pragma once

#include "renderer/kernels/bsdf/reverse.h"
#include "renderer/kernels/film/add_sample.h"
#include "renderer/kernels/geometry/surface_hit.h"
#include "renderer/kernels/mis/bidirectional.h"
#include "renderer/kernels/mis/truncated.h"
#include "renderer/kernels/path/scatter_table.h"
#include "renderer/kernels/path/trials.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/kernels/scene_view.h"
#include "renderer/shared/integrator_settings.h"
#include "renderer/shared/path_state.h"

/// Returns whether a path ends at a hit after `depth` scattering events because of the depth limit.
///
/// The ray of the last scattering event counts only if it can find light: in implicit paths, or
/// after a delta event. A light path needs no such ray, since its last event is the one connected
/// to the camera.
DEVICE bool is_last_hit(IntegratorSettings settings, uint depth) {
    const bool last_ray_finds_light =
        !FEATURE_from_light && (FEATURE_delta || (settings.strategies & STRATEGY_IMPLICIT) != 0u);
    return FEATURE_depth_limit && depth + (last_ray_finds_light ? 0u : 1u) >= settings.max_depth;
}

/// Divides the throughput of a path by the probability with which roulette continues it, and
/// returns false if the path ends.
///
/// Thesis, section 2.7.2: from the first bounce on, the continuation probability is proportional to
/// throughput. The bound below 1 ends paths between surfaces that absorb nothing. It is close to 1
/// because the variance is infinite if the squared albedo exceeds it. The probability is part of
/// the contribution, but not of the MIS densities.
///
/// Inside glass radiance is larger by eta^2, a factor that the path loses on its way out. Roulette
/// excludes this factor (PBRT 4th ed., section 13.2.2), hence `scale_change`. The throughput of a
/// light path is measured relative to its initial value.
///
/// At a delta, roulette gains nothing while the throughput is high: no other strategy follows the
/// path there, and its next hit may be a light. It starts below `settings.roulette_start`. The
/// thesis' mode is 1. No path ends before event `settings.roulette_event`; there, the probability
/// is that of all events so far.
DEVICE bool survives_roulette(Path path, IntegratorSettings settings, float largest,
                              float scale_change, bool is_delta, float u,
                              PRIVATE float3 *throughput) {
    float scale = 1.0f;
    if (FEATURE_roulette_scale) {
        scale = get_roulette_scale(path) * scale_change;
        set_roulette_scale(path, scale);
    }
    if (FEATURE_late_roulette && get_depth(path) + 1u < settings.roulette_event) {
        return true;
    }
    float continuation = min(largest / scale, settings.max_continuation);
    if (FEATURE_delta && is_delta && largest / scale >= settings.roulette_start) {
        continuation = settings.max_continuation;
    }
    if (!(u < continuation)) {
        return false;
    }
    *throughput = *throughput / continuation;
    return true;
}

/// Updates R or Q, and S, at a scattering event after `depth` events: MIS (11), (15), (19), (20).
DEVICE void continue_ratios(Path path, IntegratorSettings settings, uint depth, bool is_delta,
                            ScatterEvent event) {
    const float log_r_or_q = get_log_running_ratio(path);
    const float log_a = get_log_inverse_arrival(path);
    set_log_running_ratio(
        path, FEATURE_from_light
                  ? continue_light_ratio(log_r_or_q, log_a, depth, is_delta, event.log_forward,
                                         event.log_reverse_ratio, settings.beta)
                  : continue_camera_ratio(log_r_or_q, depth, is_delta, event.log_forward,
                                          event.log_reverse_ratio));
    if (FEATURE_light_path_trials && FEATURE_from_light) {
        set_trial_ratio(
            path, continue_light_ratio(get_trial_ratio(path), -INFINITY, depth, is_delta,
                                       event.log_forward, event.log_reverse_ratio, settings.beta));
    }
    if (FEATURE_vertex_connections) {
        set_log_strategies(
            path, continue_strategies(get_log_strategies(path), log_a, is_delta, event.log_forward,
                                      event.log_reverse_ratio, settings.beta));
    }
}

/// Samples scattering at the hit, by the words of BLOCK_SCATTER, and moves the path's ray there.
/// Returns false if the path ends.
DEVICE bool scatter(Path path, PRIVATE const SceneView *scene, IntegratorSettings settings,
                    uint4 words) {
    const uint primitive = get_hit_primitive(path);
    const uint depth = get_depth(path);
    if (!FEATURE_scattering || primitive == NO_HIT || is_last_hit(settings, depth)) {
        return false;
    }
    const SurfaceHit hit = surface_hit(scene, primitive, get_hit_at(path));
    const SurfaceFrame frame = shading_frame(scene, hit, -get_ray_direction(path));
    float by_material;
    const BsdfSample sample =
        sample_guided(scene, hit.material, frame,
                      scatter_table(path, scene, settings, hit, frame.ng), words, &by_material);
    if (!(sample.pdf_w > 0.0f)) {
        return false;
    }
    ScatterEvent event = irreversible_event();
    if (FEATURE_light_strategy || FEATURE_from_light) {
        event = scatter_event(scene, hit, frame, sample);
    }
    float3 throughput =
        get_throughput(path) * (FEATURE_from_light ? event.importance : sample.weight);
    const float largest = max(throughput.x, max(throughput.y, throughput.z));
    if (!(largest > 0.0f)) {
        return false;
    }
    const bool is_delta = !(sample.pdf_w < INFINITY);
    if (FEATURE_roulette && settings.termination == TERMINATION_ROULETTE) {
        // Importance crosses boundaries unchanged. Roulette excludes the guide: it would end the
        // paths that the guide sends to where light is.
        const float scale_change = FEATURE_from_light ? 1.0f : sample.scale * by_material;
        if (!survives_roulette(path, settings, largest, scale_change, is_delta,
                               uniform_float(words.z), &throughput)) {
            return false;
        }
    }
    if (FEATURE_adaptive && settings.termination == TERMINATION_ADAPTIVE &&
        largest < settings.adaptive_threshold) {
        return false;
    }
    set_ray_origin(path, offset_ray_origin(hit.point, sample.wi));
    set_ray_direction(path, sample.wi);
    set_throughput(path, throughput);
    set_depth(path, depth + 1u);
    set_pdf_w(path, sample.pdf_w);
    if (FEATURE_light_strategy && (settings.strategies & STRATEGY_LIGHT) != 0u) {
        continue_ratios(path, settings, depth, is_delta, event);
    }
    return true;
}

/// Scatters a path (`scatter`) after its hit has trained a guide, if the pilot of one traces it.
DEVICE bool extend(Path path, PRIVATE const SceneView *scene, IntegratorSettings settings,
                   FilmView film, uint4 words) {
    if (FEATURE_light_path_trials && FEATURE_from_light) {
        store_training_hit(path, scene, settings, (GLOBAL PathTrials *)film.words);
    }
    return scatter(path, scene, settings, words);
}
