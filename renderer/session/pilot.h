// SPDX-License-Identifier: MIT
// The pilot that chooses the number of light paths of truncated bidirectional path tracing.
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

/// One number of light paths that the pilot compared.
struct PilotTrial {
    double per_pixel = 0;  ///< light paths per pixel
    double variance = 0;   ///< variance of one sample's luminance, mean over pixels
    /// Time of one sample per pixel, in units of the time of a ray of a path tracer.
    double cost = 0;
};

/// Trials of a pilot and its choice.
struct Pilot {
    std::vector<PilotTrial> trials;
    /// Light paths per sample of the image with the least variance times cost, possibly 0.
    uint32_t light_paths = 0;
    double seconds = 0;       ///< device time
    double wall_seconds = 0;  ///< wall time, without compilation
};

/// Returns the settings of the session that traces the paths of a pilot for `settings`.
RenderSettings pilot_settings(const RenderSettings &settings);

/// Chooses the number of light paths for `settings` among 0 and the powers of 4 from 1/64 to 64 per
/// pixel, without 0 if only light paths see some light of the scene.
///
/// The pilot traces two camera paths in every pixel, or in every pixel of a lattice of at most
/// 65,536, and as many light paths. The variance of the camera pass is estimated from the two
/// samples of a pixel. That of the light pass is the second moment of a path's contributions, for
/// hardly any two paths meet in a pixel. Both are those of independent samples, whatever the
/// sampler. The cost is counted in rays. Variance and cost are the same in every run on one device,
/// and so is the choice. The pilot uses its own seed; its samples are discarded.
Pilot choose_light_paths(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                         const RenderSettings &settings);

}  // namespace rtrays
