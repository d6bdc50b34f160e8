// SPDX-License-Identifier: MIT
// Rules of settings: which of them an algorithm supports, which exclude each other, and which it
// fixes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/base/error.h"
#include "renderer/session/settings.h"

namespace rtrays {

namespace {

void require_supported_choices(const RenderSettings &settings) {
    const Algorithm &algorithm = *settings.algorithm;
    const std::pair<PathStrategies, bool> choices[] = {
        {PathStrategies::implicit_only, algorithm.may_be_implicit},
        {PathStrategies::explicit_only, algorithm.may_be_explicit}};
    for (const auto &[choice, is_possible] : choices) {
        if (settings.strategies == choice && !is_possible) {
            throw input_error(fmt::format(
                "integrator.strategies={}: not supported by {}; use mis or path_tracing",
                name_in(path_strategies, choice), algorithm.name));
        }
    }
    if (algorithm.is_random && settings.sampler == Sampler::regular) {
        throw input_error(fmt::format(
            "integrator.sampler=regular: {} needs random numbers; use independent or sobol",
            algorithm.name));
    }
    if (!algorithm.is_random && settings.sampler == Sampler::sobol) {
        throw input_error(fmt::format(
            "integrator.sampler=sobol: {} draws no random numbers; use regular", algorithm.name));
    }
    if (!algorithm.is_random && (settings.light_selection == LightSelection::uniform ||
                                 settings.light_selection == LightSelection::power)) {
        throw input_error(fmt::format(
            "integrator.light_selection={}: {} samples every light at every point; use independent",
            name_in(light_selections, settings.light_selection), algorithm.name));
    }
}

void require_consistent_light_paths(const RenderSettings &settings) {
    const Algorithm &algorithm = *settings.algorithm;
    if (algorithm.light_paths == LightPaths::one_per_camera_path &&
        settings.light_paths != LIGHT_PATHS_LIKE_PIXELS) {
        throw input_error(fmt::format(
            "integrator.light_paths: {} traces one light path per camera path; use pixels",
            algorithm.name));
    }
    if (settings.light_paths == LIGHT_PATHS_AUTO && algorithm.light_paths != LightPaths::any) {
        throw input_error(
            fmt::format("integrator.light_paths=auto: not supported by {}; use pixels, a number or "
                        "truncated_bdpt",
                        algorithm.name));
    }
    if (settings.light_paths == 0 && algorithm.light_paths == LightPaths::at_least_one) {
        throw input_error(fmt::format(
            "integrator.light_paths=0: {} needs light paths; use pixels or a number above 0",
            algorithm.name));
    }
    if (!algorithm.traces_light_paths() && settings.guided_emission != GuidedEmission::off) {
        throw input_error(
            fmt::format("integrator.guided_emission={}: {} traces no light paths; use off",
                        name_in(guided_emissions, settings.guided_emission), algorithm.name));
    }
    if (settings.guided_emission == GuidedEmission::trained &&
        algorithm.light_paths != LightPaths::any) {
        throw input_error(fmt::format(
            "integrator.guided_emission=trained: not supported by {}; use off or truncated_bdpt",
            algorithm.name));
    }
    if ((settings.guided_scattering == GuidedScattering::trained ||
         settings.scatter_guide != nullptr) &&
        (algorithm.light_paths != LightPaths::any || settings.light_paths == 0)) {
        throw input_error(fmt::format(
            "integrator.guided_scattering=trained: needs the light paths of truncated_bdpt, and {} "
            "has none; use off",
            settings.light_paths == 0 ? "integrator.light_paths=0" : algorithm.name));
    }
    if (settings.guided_emission == GuidedEmission::trained && settings.light_paths == 0) {
        throw input_error(
            "integrator.guided_emission=trained: integrator.light_paths=0 leaves nothing to guide; "
            "use off, or light_paths=auto, pixels or a number above 0");
    }
    if (algorithm.light_paths == LightPaths::one_per_camera_path && settings.only_pass) {
        throw input_error(
            fmt::format("passes={}: the passes of {} share their light paths; use all",
                        to_string(*settings.only_pass), algorithm.name));
    }
}

void require_consistent_pipeline(const RenderSettings &settings) {
    const Algorithm &algorithm = *settings.algorithm;
    if (settings.pipeline == Pipeline::megakernel && !algorithm.has_megakernel) {
        throw input_error(
            fmt::format("device.pipeline=megakernel: supports path_tracing only; {} needs "
                        "device.pipeline=wavefront",
                        algorithm.name));
    }
    if (settings.pipeline == Pipeline::megakernel && settings.count_rays == RayCounts::by_depth) {
        throw input_error(
            "device.count_rays=by_depth: counts rays in the streams between stages; use "
            "device.pipeline=wavefront");
    }
    if (settings.pipeline == Pipeline::megakernel && settings.separate_strategies) {
        throw input_error(
            "layers of strategies: not supported by megakernel; use device.pipeline=wavefront");
    }
}

void require_consistent_convergence(const RenderSettings &settings) {
    if (!has_convergence_control(settings)) {
        return;
    }
    if (!settings.algorithm->stops_pixels) {
        std::vector<std::string> names;
        for (const Algorithm *algorithm : all_algorithms()) {
            if (algorithm->stops_pixels) {
                names.emplace_back(algorithm->name);
            }
        }
        throw input_error(fmt::format(
            "integrator.convergence.error={}: {} does not support convergence control; {} do",
            settings.convergence_error, settings.algorithm->name, fmt::join(names, " and ")));
    }
    if (settings.separate_strategies) {
        throw input_error(
            "integrator.convergence.error: convergence is decided by the full image, which layers "
            "of strategies split; use one of the two");
    }
    for (const auto &[name, samples] : {std::pair("interval", settings.convergence_interval),
                                        std::pair("start", settings.convergence_start)}) {
        if (samples == 0 || samples % 2 != 0) {
            throw input_error(
                fmt::format("integrator.convergence.{}={}: must be even and not 0, because half of "
                            "the samples are compared with all",
                            name, samples));
        }
    }
}

}  // namespace

void require_consistent(const RenderSettings &settings) {
    const Algorithm &algorithm = *settings.algorithm;
    require_supported_choices(settings);
    require_consistent_light_paths(settings);
    if (settings.separate_strategies && (settings.variance || settings.only_pass)) {
        throw input_error(
            "layers of strategies: render all passes and omit the layer 'variance'; the strategies "
            "share their paths");
    }
    require_consistent_pipeline(settings);
    if (settings.separate_strategies && !algorithm.is_random) {
        throw input_error(
            fmt::format("layers of strategies: {} has only one strategy", algorithm.name));
    }
    if (algorithm.is_random && settings.termination == Termination::fixed &&
        settings.max_depth == 0) {
        throw input_error(
            "integrator.termination=fixed: needs a limit; use --set integrator.max_depth=N");
    }
    require_consistent_convergence(settings);
}

RenderSettings with_fixed_choices(RenderSettings settings) {
    const Algorithm &algorithm = *settings.algorithm;
    if (!algorithm.is_random) {
        settings.strategies = PathStrategies::explicit_only;
        settings.sampler = Sampler::regular;
        settings.light_selection = LightSelection::independent;
        if (settings.termination == Termination::roulette) {
            settings.termination = Termination::fixed;
        }
    }
    if (algorithm.fixed_depth > 0) {
        settings.max_depth = algorithm.fixed_depth;
    } else if (settings.max_depth == 0) {
        settings.max_depth = algorithm.default_depth;
    }
    return settings;
}

Sampler default_sampler(const Algorithm &algorithm) {
    return algorithm.is_random ? Sampler::sobol : Sampler::regular;
}

}  // namespace rtrays
