// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/device/source.h"
#include "renderer/pipeline/compile_scene.h"
#include "renderer/shared/integrator_settings.h"

namespace rtrays {

struct BvhBuildParameters;

/// Values of RenderSettings::light_paths: as many as pixels; of truncated_bdpt, as many as pay
/// (pipeline/pilot.h).
constexpr uint32_t LIGHT_PATHS_LIKE_PIXELS = 0xffffffffu;
constexpr uint32_t LIGHT_PATHS_AUTO = 0xfffffffeu;

/// Everything a render depends on besides the scene and the device. `integrator.*` and `device.*`
/// settings have the names of their fields.
struct RenderSettings {
    std::string algorithm = "path_tracing";
    int width = 0;   ///< pixels; 0: the scene's film
    int height = 0;  ///< pixels; 0: the scene's film
    uint32_t seed = 1;
    bool variance = true;  ///< keep second moments: layers variance.R, .G, .B
    std::string passes =
        "all";  ///< all | camera | light: the passes of the algorithm that are rendered
    bool strategies_apart =
        false;  ///< layers of what each strategy contributes; instead of second moments

    // integrator.*
    std::string strategies = "mis";       ///< implicit | explicit | mis; of path_tracing
    std::string sampler = "independent";  ///< independent | sobol | regular
    std::string seen_emitters = "mis";    ///< mis | camera; of bdpt and truncated_bdpt
    uint32_t light_paths =
        LIGHT_PATHS_LIKE_PIXELS;  ///< per sample of the image; also LIGHT_PATHS_AUTO
    uint32_t bdpt_vertices = 8;   ///< of bdpt: vertices kept of each light path; paths of one
                                 ///< scattering event more are the longest that all strategies find
    float beta = 2.0f;                     ///< exponent of the power heuristic, > 0
    std::string termination = "roulette";  ///< roulette | fixed | adaptive
    uint32_t max_depth = 0;                ///< scattering events, 0: no limit
    float max_continuation =
        0x1.ffffep-1f;  ///< largest continuation probability of roulette, in (0, 1); 1 - 2^-20
    float adaptive_threshold = 0.01f;       ///< throughput below which adaptive termination stops
    std::string light_selection = "mixed";  ///< uniform | power | mixed | independent
    std::string sphere_sampling = "cone";   ///< cone | area
    float convergence_error =
        0.0f;  ///< relative change at which a pixel stops (biased), 0: none stops
    uint32_t convergence_interval = 50;  ///< samples between two checks, even
    uint32_t convergence_start = 200;    ///< samples of the first check, even

    // device.*
    uint32_t group_size = 0;       ///< work-items per group, 0: the device's default
    uint32_t stream_capacity = 0;  ///< paths in flight, 0: the device's default
    uint32_t stream_chunk = 0;     ///< queue entries per work-item, 0: the device's default
    std::string path_layout =
        "auto";  ///< auto | interleaved | arrays: words of a path together, or word by word
    std::string bvh_layout = "auto";  ///< auto | bvh2 | bvh2_stackless | wide8: of the hierarchy
    std::string bvh_builder = "binned_sah";  ///< binned_sah | hploc
    std::string bvh_bins = "16";             ///< 4 | 8 | 16 | 32: on an axis, of binned_sah
    std::string bvh_axes = "all";            ///< all | widest: that are binned, of binned_sah
    std::string bvh_update = "rebuild";      ///< rebuild | refit: when the scene has moved
    std::string pipeline =
        "wavefront";  ///< wavefront | megakernel: a kernel for every block, or one for all
    std::string count_rays = "in_all";  ///< in_all | by_depth: what `--stats` says of rays
    std::string features = "scene";     ///< scene | all: what is compiled in

    SourceOverlays source_overlays;  ///< planted errors of the tests
};

/// Applies `NAME=VALUE` with NAME "integrator.beta" and so on. Throws `Error` (bad usage) naming
/// the alternatives when the name or an enumerated value is unknown, or the value malformed or out
/// of range.
void apply_setting(RenderSettings &settings, const std::string &assignment);

/// Throws `Error` (bad usage) when settings contradict each other or a name is none of its
/// alternatives.
void require_consistent(const RenderSettings &settings);

/// Consistent settings in which the choices that the algorithm makes by itself have been made:
/// those of ray_casting and whitted, which draw no random numbers (thesis 2.7.6).
RenderSettings with_fixed_choices(RenderSettings settings);

/// All settings that decide the image ("integrator.*", algorithm), for provenance and for the
/// config hash.
nlohmann::json image_settings(const RenderSettings &settings);

/// Which of them are not the defaults: "integrator.beta=1".
std::vector<std::string> changed_settings(const RenderSettings &settings);

/// All names with their values and meanings, a line each, for --help.
std::string describe_settings();

/// Names of the algorithms there are.
const std::vector<std::string> &algorithm_names();

// Of consistent settings:

/// The algorithm that is run: truncated_bdpt without light paths is path_tracing.
std::string scheduled_algorithm(const RenderSettings &settings);

/// Whether the algorithm traces paths from the lights: its image has splats.
bool has_light_pass(const RenderSettings &settings);

/// Whether pixels are stopped as they converge, which biases the image.
bool has_convergence_control(const RenderSettings &settings);

/// Light paths per sample of the image, in algorithms that trace some. LIGHT_PATHS_AUTO must have
/// been replaced.
uint32_t light_paths_per_sample(const RenderSettings &settings);

/// The numbers as the stages take them.
IntegratorSettings integrator_settings(const RenderSettings &settings);
CompileSettings compile_settings(const RenderSettings &settings);

/// Sets what decides the tree: device.bvh_builder, bvh_bins, bvh_axes.
void choose_builder(const RenderSettings &settings, BvhBuildParameters &parameters);

/// The features that the settings add to those of the scene.
FeatureMask settings_features(const RenderSettings &settings);

}  // namespace rtrays
