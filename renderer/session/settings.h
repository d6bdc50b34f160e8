// SPDX-License-Identifier: MIT
// Render settings: fields and defaults, text, consistency, and conversion for the other modules.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "renderer/bvh/bvh.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/compile/emission_guide.h"
#include "renderer/compile/scatter_guide.h"
#include "renderer/device/source.h"
#include "renderer/integrators/algorithm.h"
#include "renderer/session/setting_values.h"
#include "renderer/shared/integrator_settings.h"

namespace rtrays {

struct BvhBuildParameters;

/// Special values of RenderSettings::light_paths: one per pixel, and a number that a pilot render
/// chooses (truncated_bdpt only; session/pilot.h).
constexpr uint32_t LIGHT_PATHS_LIKE_PIXELS = 0xffffffffu;
constexpr uint32_t LIGHT_PATHS_AUTO = 0xfffffffeu;

/// Everything that a render depends on besides the scene and the device. The names of the
/// `integrator.*` and `device.*` settings are those of the fields; a field `convergence_x` is the
/// setting integrator.convergence.x.
struct RenderSettings {
    const Algorithm *algorithm = &algorithms::path_tracing;
    int width = 0;   ///< image width in pixels, 0: from the scene's film
    int height = 0;  ///< image height in pixels, 0: from the scene's film
    /// The full picture of which the image is a window; without a width, the image is all of it.
    struct Window {
        int x = 0, y = 0;  ///< pixel of the full picture with which the image begins
        int full_width = 0, full_height = 0;
    } window;
    uint32_t seed = 1;
    /// Whether the film stores what the layers variance.R, .G, .B need.
    bool variance = true;
    /// The only pass that is rendered, if not all of them are.
    std::optional<PassKind> only_pass;
    /// Whether paths are traced for a pilot and not for an image (session/pilot.h).
    bool light_path_trials = false;
    /// Whether such a pilot stores the hits of light paths too, to train a scatter guide.
    bool stores_training_hits = false;
    /// Whether the image has a layer per strategy, with its contribution; this excludes `variance`.
    bool separate_strategies = false;

    // integrator.*
    PathStrategies strategies = PathStrategies::mis;
    Sampler sampler = Sampler::independent;
    SeenEmitters seen_emitters = SeenEmitters::mis;
    /// Light paths per sample of the image, or LIGHT_PATHS_LIKE_PIXELS or LIGHT_PATHS_AUTO.
    uint32_t light_paths = LIGHT_PATHS_LIKE_PIXELS;
    GuidedEmission guided_emission = GuidedEmission::off;
    /// The tables that guide emission, made for the lights of the scene; null: none. A session sets
    /// it for `GuidedEmission::flat` and `trained`.
    std::shared_ptr<const EmissionGuide> emission_guide;
    GuidedScattering guided_scattering = GuidedScattering::off;
    /// The tables that guide camera paths; null: none. A session sets it for
    /// `GuidedScattering::trained`.
    std::shared_ptr<const ScatterGuide> scatter_guide;
    /// Vertices of each light path that bdpt stores. All strategies sample paths of at most one
    /// scattering event more than that.
    uint32_t bdpt_vertices = 8;
    /// Exponent of the power heuristic, above 0.
    float beta = 2.0f;
    Termination termination = Termination::roulette;
    /// Maximum number of scattering events, 0: no limit.
    uint32_t max_depth = 0;
    /// Largest continuation probability of Russian roulette, in (0, 1). The default is 1 - 2^-20.
    float max_continuation = 0x1.ffffep-1f;
    /// Throughput below which roulette may end a path at a delta, 1: always (thesis).
    float roulette_start = 1.0f;
    /// First scattering event at which roulette may end a path, 1: the first (thesis).
    uint32_t roulette_event = 1;
    /// Throughput below which adaptive termination ends a path.
    float adaptive_threshold = 0.01f;
    LightSelection light_selection = LightSelection::mixed;
    SphereSampling sphere_sampling = SphereSampling::cone;
    /// Relative change of a pixel's mean below which the pixel stops (biased), 0: no pixel stops.
    float convergence_error = 0.0f;
    /// Samples between two convergence checks, even.
    uint32_t convergence_interval = 50;
    /// Samples before the first convergence check, even.
    uint32_t convergence_start = 200;

    // device.*
    /// Work-items per group, 0: the device's default.
    uint32_t group_size = 0;
    /// Paths in flight, 0: the device's default.
    uint32_t stream_capacity = 0;
    /// Queue entries per work-item, 0: the device's default.
    uint32_t stream_chunk = 0;
    /// Layout of path states; without a value, that of the device.
    std::optional<PathLayout> path_layout;
    /// Layout of the BVH; without a value, that of the device.
    std::optional<BvhLayout> bvh_layout;
    BvhMethod bvh_builder = BvhMethod::binned_sah;
    uint32_t bvh_bins = 16;  ///< bins per axis of binned_sah (bvh_bins_choices)
    uint32_t bvh_axes = 3;   ///< axes that binned_sah bins (bvh_axes_choices)
    BvhUpdate bvh_update = BvhUpdate::rebuild;
    Pipeline pipeline = Pipeline::wavefront;
    RayCounts count_rays = RayCounts::in_all;
    CompiledFeatures features = CompiledFeatures::scene;

    /// Replaced kernel sources, with which tests plant errors.
    SourceOverlays source_overlays;
};

/// Applies an assignment `NAME=VALUE`, for instance "integrator.beta=1". Throws `Error` (bad usage)
/// that lists the alternatives when name or value is unknown, malformed or out of range.
void apply_setting(RenderSettings &settings, const std::string &assignment);

/// Throws `Error` (bad usage) when settings contradict each other or do not suit the algorithm.
void require_consistent(const RenderSettings &settings);

/// Returns consistent settings with the choices filled in that an algorithm makes itself. They
/// concern ray_casting and whitted, which draw no random numbers (thesis 2.7.6).
RenderSettings with_fixed_choices(RenderSettings settings);

/// Returns the sampler of rtrays-render if integrator.sampler is not set: Sobol points, or the
/// regular ones of an algorithm without random numbers. `RenderSettings` and thus experiments have
/// the independent samples of the thesis.
Sampler default_sampler(const Algorithm &algorithm);

/// Returns all settings that decide the image (the algorithm and "integrator.*"), for provenance
/// and for the hash of the configuration.
nlohmann::json image_settings(const RenderSettings &settings);

/// Returns the "integrator.*" settings that differ from the defaults, as "integrator.beta=1".
std::vector<std::string> changed_settings(const RenderSettings &settings);

/// Returns the names, values and meanings of all settings for --help, with their values in
/// `defaults`, wrapped to 100 columns.
std::string describe_settings(const RenderSettings &defaults);

// The functions below expect consistent settings.

/// Makes the image the window `crop` of a picture of the given size.
void set_window(RenderSettings &settings, const FilmCrop &crop, int full_width, int full_height);

/// Returns whether paths from the lights are traced, which splat to any pixel.
bool has_light_pass(const RenderSettings &settings);

/// Returns whether tables guide the directions of light paths.
bool has_guided_emission(const RenderSettings &settings);

/// Returns whether tables guide camera paths behind mirrors and glass.
bool has_guided_scattering(const RenderSettings &settings);

/// Returns whether the film holds a sum for each Sobol sequence, for the variance layer.
bool has_sequence_sums(const RenderSettings &settings);

/// Returns whether pixels stop when they have converged, which biases the image.
bool has_convergence_control(const RenderSettings &settings);

/// Returns the number of light paths per sample of the image, for algorithms that trace light
/// paths. LIGHT_PATHS_AUTO must have been replaced.
uint32_t light_paths_per_sample(const RenderSettings &settings);

/// Returns the settings in the form that the stages receive.
IntegratorSettings integrator_settings(const RenderSettings &settings);

/// Returns the settings that decide the compiled scene.
CompileSettings compile_settings(const RenderSettings &settings);

/// Copies device.bvh_builder, bvh_bins and bvh_axes, which decide the BVH's tree, to `parameters`.
void choose_builder(const RenderSettings &settings, BvhBuildParameters &parameters);

/// Returns the features that the settings add to those of the scene.
FeatureMask settings_features(const RenderSettings &settings);

}  // namespace rtrays
