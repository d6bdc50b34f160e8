// SPDX-License-Identifier: MIT
// Settings of a reference render.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace rtrays {

/// Estimators of direct light that a path uses: emission hit by the path (implicit), light sampled
/// at every vertex (explicit; next-event estimation), or both combined by multiple importance
/// sampling (power heuristic, beta = 2).
enum class Strategies { implicit_only, explicit_only, mis };

/// Names of the strategies. Parsing, printing, help and error messages all read this table.
constexpr std::array<std::pair<const char *, Strategies>, 3> strategies_names{{
    {"implicit", Strategies::implicit_only},
    {"explicit", Strategies::explicit_only},
    {"mis", Strategies::mis},
}};

std::string name_of(Strategies strategies);

/// Parses the name of a strategy. Throws `Error` (bad input) listing the alternatives.
Strategies strategies_from_name(const std::string &name);

/// Restriction to the light that light tracing can connect to the camera. It excludes light at
/// infinity that the camera sees directly, and everything that the camera sees in mirrors and
/// smooth glass. Of the light from infinity it includes only the light that passes through a ball.
struct JoinableLight {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = std::numeric_limits<double>::infinity();

    /// Returns whether parallel light of direction `d` (unit) that falls on `point` passes through
    /// the ball.
    bool reaches(const Eigen::Vector3d &point, const Eigen::Vector3d &d) const {
        return (point - centre).cross(d).squaredNorm() < radius * radius;
    }
};

/// Settings that a reference image depends on, besides the scene. Only `threads` changes no bit.
struct ReferenceSettings {
    int width = 0;
    int height = 0;
    /// The full picture of which the image is a window; without a width, the image is all of it.
    int full_width = 0, full_height = 0;
    int crop_x = 0, crop_y = 0;  ///< pixel of the full picture with which the image begins
    size_t camera = 0;           ///< index into CameraArrays
    uint64_t seed = 1;
    Strategies strategies = Strategies::mis;
    /// Maximum number of scattering events; 1 is direct light, 0 means no limit.
    uint32_t max_depth = 0;
    /// Russian roulette. If false, paths end at `max_depth` alone, for timings against renderers
    /// without roulette.
    bool roulette = true;
    std::optional<JoinableLight> joinable_only;  ///< nothing: all light
    int threads = 0;                             ///< 0: all
};

}  // namespace rtrays
