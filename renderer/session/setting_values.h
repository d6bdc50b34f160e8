// SPDX-License-Identifier: MIT
// Values of settings that have names. Parsing, printing, --help and messages use their tables, and
// values that the device knows are its constants.
#pragma once

#include <cstdint>

#include "renderer/base/named.h"
#include "renderer/shared/integrator_settings.h"

namespace rtrays {

/// Strategies of path_tracing: paths that hit emitters, next-event estimation, or both with
/// multiple importance sampling.
enum class PathStrategies { implicit_only, explicit_only, mis };
inline constexpr Named<PathStrategies> path_strategies[] = {
    {PathStrategies::implicit_only, "implicit"},
    {PathStrategies::explicit_only, "explicit"},
    {PathStrategies::mis, "mis"}};

/// Random numbers, or a fixed set of points that is the same in every pixel.
enum class Sampler : uint32_t {
    independent = SAMPLER_INDEPENDENT,
    sobol = SAMPLER_SOBOL,
    regular = SAMPLER_REGULAR
};
inline constexpr Named<Sampler> samplers[] = {{Sampler::independent, "independent"},
                                              {Sampler::sobol, "sobol"},
                                              {Sampler::regular, "regular"}};

/// Passes of bdpt and truncated_bdpt that add emitters seen directly: both or the camera pass.
enum class SeenEmitters { mis, camera };
inline constexpr Named<SeenEmitters> seen_emitters_choices[] = {{SeenEmitters::mis, "mis"},
                                                                {SeenEmitters::camera, "camera"}};

/// Directions in which light paths start: those of the light alone, or by tables whose bins are all
/// equal, or by tables that a pilot trains.
enum class GuidedEmission { off, flat, trained };
inline constexpr Named<GuidedEmission> guided_emissions[] = {{GuidedEmission::off, "off"},
                                                             {GuidedEmission::flat, "flat"},
                                                             {GuidedEmission::trained, "trained"}};

/// Directions in which camera paths scatter behind mirrors and glass: those of the material, or
/// also by tables that a pilot trains.
enum class GuidedScattering { off, trained };
inline constexpr Named<GuidedScattering> guided_scatterings[] = {
    {GuidedScattering::off, "off"}, {GuidedScattering::trained, "trained"}};

/// How paths end.
enum class Termination : uint32_t {
    roulette = TERMINATION_ROULETTE,
    fixed = TERMINATION_FIXED,
    adaptive = TERMINATION_ADAPTIVE
};
inline constexpr Named<Termination> terminations[] = {{Termination::roulette, "roulette"},
                                                      {Termination::fixed, "fixed"},
                                                      {Termination::adaptive, "adaptive"}};

/// Layout of path states: all words of a path together, or an array per word.
enum class PathLayout { interleaved, arrays };
inline constexpr Named<PathLayout> path_layouts[] = {{PathLayout::interleaved, "interleaved"},
                                                     {PathLayout::arrays, "arrays"}};

/// Numbers of bins per axis of binned_sah.
inline constexpr Named<uint32_t> bvh_bins_choices[] = {{4, "4"}, {8, "8"}, {16, "16"}, {32, "32"}};

/// Numbers of axes that binned_sah bins.
inline constexpr Named<uint32_t> bvh_axes_choices[] = {{3, "all"}, {1, "widest"}};

/// Update of the BVH when the scene has moved.
enum class BvhUpdate { rebuild, refit };
inline constexpr Named<BvhUpdate> bvh_updates[] = {{BvhUpdate::rebuild, "rebuild"},
                                                   {BvhUpdate::refit, "refit"}};

/// One kernel per stage, or one kernel for all of them.
enum class Pipeline { wavefront, megakernel };
inline constexpr Named<Pipeline> pipelines[] = {{Pipeline::wavefront, "wavefront"},
                                                {Pipeline::megakernel, "megakernel"}};

/// Ray counts in the document of `--stats`.
enum class RayCounts { in_all, by_depth };
inline constexpr Named<RayCounts> ray_counts_choices[] = {{RayCounts::in_all, "in_all"},
                                                          {RayCounts::by_depth, "by_depth"}};

/// Features that are compiled in: those that scene and settings use, or all.
enum class CompiledFeatures { scene, all };
inline constexpr Named<CompiledFeatures> compiled_features[] = {{CompiledFeatures::scene, "scene"},
                                                                {CompiledFeatures::all, "all"}};

}  // namespace rtrays
