// SPDX-License-Identifier: MIT
// Algorithms: what each of them computes, sees and supports, and its passes.
#pragma once

#include <string>
#include <vector>

#include "renderer/integrators/pass.h"
#include "renderer/integrators/sight.h"

namespace rtrays {

/// Numbers of light paths that an algorithm can trace in a sample of the image.
enum class LightPaths {
    none,
    any,                  ///< also 0: the algorithm then has only its paths from the camera
    at_least_one,         ///< the image consists of light paths alone
    one_per_camera_path,  ///< passes share the light paths, because their vertices are connected
};

/// An algorithm: a row of the registry. A file of this folder defines each of them.
struct Algorithm {
    const char *name = nullptr;
    /// Contents of the image, in a few words.
    const char *computes = nullptr;
    /// Classes of light paths in the image.
    Sight sees;
    bool traces_camera_paths = true;
    LightPaths light_paths = LightPaths::none;
    /// Whether it draws random numbers. Otherwise its samples use a fixed set of points, and every
    /// vertex is connected to every light.
    bool is_random = true;
    /// Whether it may do without light samples (integrator.strategies=implicit), and without the
    /// weighting of emission that paths hit (integrator.strategies=explicit).
    bool may_be_implicit = false, may_be_explicit = false;
    /// Whether convergence control may stop its camera paths in a pixel.
    bool stops_pixels = false;
    /// Whether one kernel can trace complete paths (device.pipeline=megakernel).
    bool has_megakernel = false;
    /// Maximum number of scattering events that replaces every other, 0: integrator.max_depth is
    /// valid.
    uint32_t fixed_depth = 0;
    /// Maximum number of scattering events if integrator.max_depth is 0, 0: no limit.
    uint32_t default_depth = 0;
    /// Features that no other algorithm has.
    FeatureMask features;
    /// Returns the passes, none if the scene has no light that the algorithm could see.
    std::vector<Pass> (*passes)(const PassRequest &request) = nullptr;

    bool traces_light_paths() const { return light_paths != LightPaths::none; }
};

namespace algorithms {

extern const Algorithm ray_casting;
extern const Algorithm whitted;
extern const Algorithm path_tracing;
extern const Algorithm light_tracing;
extern const Algorithm bdpt;
extern const Algorithm truncated_bdpt;

}  // namespace algorithms

/// Returns all algorithms, in the order of messages and documentation.
const std::vector<const Algorithm *> &all_algorithms();

/// Returns the names of all algorithms.
const std::vector<std::string> &algorithm_names();

/// Returns the algorithm of that name. Throws `Error` (bad usage) that lists the names if there is
/// none.
const Algorithm &algorithm_named(const std::string &name);

/// Returns the passes of an algorithm. Features that belong to other algorithms are switched off:
/// with device.features=all the request has them.
std::vector<Pass> algorithm_passes(const Algorithm &algorithm, PassRequest request);

}  // namespace rtrays
