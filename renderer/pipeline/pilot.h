// SPDX-License-Identifier: MIT
// The number of light paths of truncated bidirectional path tracing, chosen by a pilot.
//
// Light paths pay where they find what camera paths miss, and cost as much as camera paths where
// they do not (Grittmann, Yazici, Georgiev and Krivanek 2022, "Efficiency-aware multiple importance
// sampling for bidirectional rendering algorithms"). There, second moments of all candidates are
// estimated from one render; here every candidate is rendered, small and short: simpler, and the
// weights need no proxies.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/pipeline/settings.h"

namespace rtrays {

class Scene;
class DeviceContext;

/// A number of light paths that was tried.
struct PilotTrial {
    double per_pixel = 0;  ///< light paths
    double variance = 0;   ///< of one sample, mean over pixels and channels
    double rays = 0;       ///< of one sample, per pixel: closest-hit and shadow rays
};

struct Pilot {
    std::vector<PilotTrial> trials;
    uint32_t light_paths =
        0;  ///< per sample of the image: of the least variance times rays; 0: none, path tracing
    double seconds = 0;  ///< on the device
};

/// Renders `settings` with none, a quarter, one and four light paths per pixel, and four times as
/// many as long as that saves a tenth, 16 samples of an image of at most 128 x 128 pixels each. The
/// choice goes by variances and counts of rays, both the same in every run on one device; its
/// samples are no others' (of another seed), and thrown away. All trials share their camera paths,
/// so that rare bright paths that none of them finds otherwise weigh alike.
Pilot choose_light_paths(const Scene &scene, const RenderSettings &settings, DeviceContext &device);

}  // namespace rtrays
