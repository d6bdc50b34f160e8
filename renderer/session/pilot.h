// SPDX-License-Identifier: MIT
// The pilot render that chooses the number of light paths of truncated bidirectional path tracing.
//
// Light paths pay off where they find light that camera paths miss; elsewhere they only cost time
// (Grittmann, Yazici, Georgiev and Krivanek 2022, "Efficiency-aware multiple importance sampling
// for bidirectional rendering algorithms"). Those authors estimate the second moments of all
// candidates from one render. Here every candidate is rendered, at small size and with few samples:
// this is simpler, and the weights need no proxies.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/session/settings.h"

namespace rtrays {

class Scene;
class DeviceScene;

/// One number of light paths that the pilot rendered, and its cost.
struct PilotTrial {
    double per_pixel = 0;  ///< light paths per pixel
    double variance = 0;   ///< variance per sample, mean over pixels and channels
    double rays = 0;       ///< closest-hit and shadow rays of one sample, per pixel
};

/// Trials of a pilot and its choice.
struct Pilot {
    std::vector<PilotTrial> trials;
    /// Light paths per sample of the image with the least variance times rays, possibly 0.
    uint32_t light_paths = 0;
    double seconds = 0;       ///< device time
    double wall_seconds = 0;  ///< wall time, without compilation
};

/// Chooses the number of light paths for `settings`. Renders with 0, 1/4, 1 and 4 light paths per
/// pixel, without 0 if only light paths see some light of the scene. Continues with four times as
/// many, up to 256, while that reduces the cost by a tenth. Each trial takes 16 samples of an image
/// of at most 128 x 128 pixels.
///
/// The cost is variance times number of rays. Both are the same in every run on one device, and so
/// is the choice. The variance of Sobol points is that of the means of their sequences, with 8
/// samples each, so it includes what stratification gains. The pilot uses its own seed; its samples
/// are discarded. All trials share their camera paths, so that rare bright camera paths weigh
/// equally in all of them.
Pilot choose_light_paths(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                         const RenderSettings &settings);

}  // namespace rtrays
