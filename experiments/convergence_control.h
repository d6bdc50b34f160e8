// SPDX-License-Identifier: MIT
// Convergence control (thesis 3.3.7) against the same renders without it: what it saves, and how it
// biases.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/base/image.h"

namespace rtrays {

/// What one render cost and came to.
struct ControlledRender {
    Image image;
    double paths = 0;    ///< camera paths
    double rays = 0;     ///< of camera and light paths
    double seconds = 0;  ///< of the device
    double live = 1;     ///< share of the pixels that were not stopped
};

/// {"paths", "seconds", "live", "rmse", "rmse_without", "efficiency", "bias"}: means over the seeds
/// or intervals. `with[i]` and `without[i]` have the same seed, and so the same samples as far as
/// `with[i]` goes: their differences hold the bias and little noise.
///
/// "paths", "rays" and "seconds" are ratios with over without, the last a median with its 95 %
/// interval. "efficiency" is how many times fewer rays control needs for the error it ends with
/// than samples spread evenly, whose mean squared error falls as 1 / rays: (MSE x rays) without
/// over with, geometric mean with its 99 % interval. "bias": "mean", the mean over pixels and
/// channels of with - without, over that of `without`, with its 99 % interval (Student's t over the
/// seeds); and of the blocks of 16 x 16 pixels and the whole, by channel, "tests", "rejected"
/// (Holm, 0.01), "undecided" (too skewed to be tested), "largest_z", "largest_z_at".
///
/// Throws `Error` (run failed) for less than 8 seeds.
nlohmann::json compare_control(const std::vector<ControlledRender> &with,
                               const std::vector<ControlledRender> &without,
                               const Image &reference);

struct ControlOptions {
    std::filesystem::path description;  ///< schema/control.schema.json
    std::string profile = "quick";
    std::filesystem::path out;  ///< NAME.PROFILE by default
    std::string device;
    bool quiet = false;
};

/// Renders every scene of the profile by every curve, without control and with each error, and
/// writes OUT/NAME.json and OUT/NAME.md; returns OUT/NAME.md. Scenes and curves that an earlier,
/// stopped call finished are not rendered again. Throws `Error` as the renderer, references and
/// files do.
std::filesystem::path run_control(const ControlOptions &options);

}  // namespace rtrays
