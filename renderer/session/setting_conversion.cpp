// SPDX-License-Identifier: MIT
// Conversion of settings for the scene compiler, the BVH builder and the stages.
#include "renderer/bvh/builder.h"
#include "renderer/scene/scene.h"
#include "renderer/session/settings.h"

namespace rtrays {

void set_window(RenderSettings &settings, const FilmCrop &crop, int full_width, int full_height) {
    settings.width = crop.width;
    settings.height = crop.height;
    settings.window = {crop.x, crop.y, full_width, full_height};
}

bool has_light_pass(const RenderSettings &settings) {
    return settings.algorithm->traces_light_paths() && settings.light_paths != 0;
}

bool has_guided_emission(const RenderSettings &settings) {
    return has_light_pass(settings) &&
           (settings.guided_emission == GuidedEmission::flat || settings.emission_guide != nullptr);
}

bool has_guided_scattering(const RenderSettings &settings) {
    return has_light_pass(settings) && settings.scatter_guide != nullptr;
}

bool has_convergence_control(const RenderSettings &settings) {
    return settings.convergence_error > 0;
}

bool has_sequence_sums(const RenderSettings &settings) {
    return settings.variance && settings.sampler == Sampler::sobol;
}

uint32_t light_paths_per_sample(const RenderSettings &settings) {
    return settings.light_paths != LIGHT_PATHS_LIKE_PIXELS
               ? settings.light_paths
               : static_cast<uint32_t>(settings.width) * static_cast<uint32_t>(settings.height);
}

IntegratorSettings integrator_settings(const RenderSettings &settings) {
    IntegratorSettings converted{};
    converted.seed = settings.seed;
    const FeatureMask features = settings_features(settings);
    for (const auto &[feature, bit] :
         {std::pair(Feature::implicit_light, STRATEGY_IMPLICIT),
          std::pair(Feature::explicit_light, STRATEGY_EXPLICIT),
          std::pair(Feature::light_strategy, STRATEGY_LIGHT),
          std::pair(Feature::light_emitters, STRATEGY_LIGHT_EMITTERS)}) {
        converted.strategies |= features.has(feature) ? bit : 0u;
    }
    converted.sampler = static_cast<uint32_t>(settings.sampler);
    converted.light_paths = light_paths_per_sample(settings);
    converted.light_vertices = settings.bdpt_vertices;
    converted.termination = static_cast<uint32_t>(settings.termination);
    converted.max_depth = settings.max_depth == 0 ? UNLIMITED_DEPTH : settings.max_depth;
    converted.beta = settings.beta;
    converted.max_continuation = settings.max_continuation;
    converted.roulette_start = settings.roulette_start;
    converted.roulette_event = settings.roulette_event;
    converted.adaptive_threshold = settings.adaptive_threshold;
    const RenderSettings::Window &window = settings.window;
    converted.film_width = static_cast<uint32_t>(settings.width);
    converted.full_width =
        window.full_width > 0 ? static_cast<uint32_t>(window.full_width) : converted.film_width;
    converted.first_pixel =
        static_cast<uint32_t>(window.y) * converted.full_width + static_cast<uint32_t>(window.x);
    return converted;
}

CompileSettings compile_settings(const RenderSettings &settings) {
    return {settings.light_selection, settings.sphere_sampling,
            settings.features == CompiledFeatures::all, !settings.algorithm->is_random};
}

void choose_builder(const RenderSettings &settings, BvhBuildParameters &parameters) {
    parameters.method = settings.bvh_builder;
    parameters.bins = settings.bvh_bins;
    parameters.axes = settings.bvh_axes;
}

FeatureMask settings_features(const RenderSettings &settings) {
    const Algorithm &algorithm = *settings.algorithm;
    const bool traces_both = algorithm.traces_camera_paths && has_light_pass(settings);
    return algorithm.features
        .with(Feature::implicit_light,
              algorithm.traces_camera_paths && settings.strategies != PathStrategies::explicit_only)
        .with(Feature::explicit_light,
              algorithm.traces_camera_paths && settings.strategies != PathStrategies::implicit_only)
        .with(Feature::light_strategy, traces_both)
        .with(Feature::light_emitters, traces_both && settings.seen_emitters == SeenEmitters::mis)
        .with(Feature::guided_emission, has_guided_emission(settings))
        .with(Feature::guided_scattering, has_guided_scattering(settings))
        .with(Feature::light_path_trials, settings.light_path_trials)
        .with(Feature::roulette, settings.termination == Termination::roulette)
        .with(Feature::late_roulette,
              settings.termination == Termination::roulette && settings.roulette_event > 1)
        .with(Feature::adaptive, settings.termination == Termination::adaptive)
        .with(Feature::sobol, settings.sampler != Sampler::independent)
        .with(Feature::depth_limit, settings.max_depth != 0)
        .with(Feature::crop, settings.window.full_width > 0)
        .with(Feature::convergence, has_convergence_control(settings))
        .with(Feature::variance, settings.variance)
        .with(Feature::sequences, has_sequence_sums(settings));
}

}  // namespace rtrays
