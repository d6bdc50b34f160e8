// SPDX-License-Identifier: MIT
// The pilot that chooses the number of light paths of truncated bidirectional path tracing and
// whether it has explicit paths, and trains the guides of emission and of scattering.
//
// Light paths pay off where they find light that camera paths miss; elsewhere they only cost time.
// One set of paths tells the variance for every number of light paths (P. Grittmann, O. Yazici,
// I. Georgiev, J. Krivanek, "Efficiency-aware multiple importance sampling for bidirectional
// rendering algorithms", ACM TOG 41(4), 2022). Those authors use proxies for the weights. Here a
// path has all the densities that its weights depend on, so that the estimates are exact.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/session/settings.h"

namespace rtrays {

class Scene;
class DeviceScene;

/// Settings that the pilot compared.
struct PilotTrial {
    double per_pixel = 0;     ///< light paths per pixel
    bool is_explicit = true;  ///< whether camera paths are connected to light samples
    double variance = 0;      ///< variance of one sample's luminance, mean over pixels
    /// Time of one sample per pixel, in units of the time of a ray of a path tracer.
    double cost = 0;
};

/// What a pilot found.
struct Pilot {
    std::vector<PilotTrial> trials;  ///< empty if the settings have a number of light paths
    /// Light paths per sample of the image: the number with the least variance times cost, possibly
    /// 0, or that of the settings.
    uint32_t light_paths = 0;
    /// Whether camera paths are connected to light samples: the pilot's choice, or the settings'.
    bool is_explicit = true;
    /// The trained guides; null if the settings ask for none, or without light paths.
    std::shared_ptr<const EmissionGuide> emission_guide;
    std::shared_ptr<const ScatterGuide> scatter_guide;
    uint64_t rays = 0;        ///< closest-hit and shadow rays
    double seconds = 0;       ///< device time
    double wall_seconds = 0;  ///< wall time, without compilation
};

/// Returns whether a guide must be trained: the settings ask for one and have none.
bool trains_emission_guide(const RenderSettings &settings);
bool trains_scatter_guide(const RenderSettings &settings);

/// Returns whether the settings need a pilot, to choose the number of light paths or to train
/// guides.
bool needs_pilot(const RenderSettings &settings);

/// Returns the settings of the session that traces the paths of a pilot for `settings`. With a
/// given number of light paths it has no camera pass. An emission guide that must be trained is
/// flat there.
RenderSettings pilot_settings(const RenderSettings &settings);

/// Returns the pixels in which a pilot traces camera paths, as y * width + x: a rank-1 lattice of
/// about an eighth of the image's pixels, 1,024 (or all) to 16,384 of them. Any two rows, and any
/// two columns, have the same number of these pixels or differ by one, so that axis-aligned edges,
/// such as those of a lamp, have their share.
std::vector<uint32_t> pilot_pixels(uint32_t width, uint32_t height);

/// Chooses the number of light paths for `LIGHT_PATHS_AUTO` among 0 and the powers of 4 from 1/64
/// to 64 per pixel, with and without explicit paths. Choices that miss some light of the scene are
/// left out.
///
/// The pilot traces `TRIAL_SAMPLES` camera paths in every one of `pilot_pixels`, which is about one
/// path per pixel of the image, and as many light paths. The variance of the camera pass is
/// estimated from the samples of a pixel; with Sobol points, from the means of its two sequences,
/// without emission that the camera sees directly (kernels/path/emission_hit.h).
/// That of the light pass is the second moment of a path's contributions, for hardly any two paths
/// meet in a pixel. It is that of independent samples, whatever the sampler. The cost is counted in
/// rays. Variance and cost are the same in every run on one device, and so is the choice. The pilot
/// uses its own seed; its samples are discarded.
///
/// To train guides, a quarter of the light paths are traced first. Camera paths and half of the
/// light paths follow under the guides that these train. Where light paths are of no use there, the
/// pilot ends. Otherwise all paths are traced under the guides that both sets of light paths train;
/// they choose, and all three sets of light paths train the final guides. An emission guide takes
/// the weights of the power of 4 nearest to the number of light paths; a scatter guide takes the
/// hits (`make_scatter_guide`). Sums are added in the order of the paths, so the guides are the
/// same in every run on one device. If the scene has no light to guide, or too many, there is no
/// emission guide with `LIGHT_PATHS_AUTO`; otherwise `Error` (bad input) is thrown.
Pilot run_pilot(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                RenderSettings settings);

}  // namespace rtrays
