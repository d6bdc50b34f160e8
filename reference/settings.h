// SPDX-License-Identifier: MIT
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

/// Which estimators of direct light a path uses: light hit by chance, light sampled at every vertex
/// (next-event estimation), or both by multiple importance sampling (power heuristic, beta = 2).
enum class Strategies { implicit_only, explicit_only, mis };

/// Their names: parsing, printing, help and error messages all read this table.
constexpr std::array<std::pair<const char *, Strategies>, 3> strategies_names{{
    {"implicit", Strategies::implicit_only},
    {"explicit", Strategies::explicit_only},
    {"mis", Strategies::mis},
}};

std::string name_of(Strategies strategies);

/// Throws `Error` (bad input) listing the alternatives.
Strategies strategies_from_name(const std::string &name);

/// The light that light tracing sees: without light at infinity that the camera looks at, without
/// what the camera sees in mirrors and smooth glass, and of light from infinity only what comes
/// through a ball.
struct JoinableLight {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = std::numeric_limits<double>::infinity();

    /// Whether parallel light of direction `d` (unit) that falls on `point` comes through the ball.
    bool reaches(const Eigen::Vector3d &point, const Eigen::Vector3d &d) const {
        return (point - centre).cross(d).squaredNorm() < radius * radius;
    }
};

/// What a reference image depends on besides the scene (`threads` apart, which changes no bit).
struct ReferenceSettings {
    int width = 0;
    int height = 0;
    size_t camera = 0;  ///< index into CameraArrays
    uint64_t seed = 1;
    Strategies strategies = Strategies::mis;
    uint32_t max_depth = 0;  ///< scattering events, 1 is direct light; 0: no limit
    bool roulette =
        true;  ///< false: paths end at max_depth alone, to be timed against others that do
    std::optional<JoinableLight> joinable_only;  ///< nothing: all light
    int threads = 0;                             ///< 0: all
};

}  // namespace rtrays
