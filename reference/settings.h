// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

/// What a reference image depends on besides the scene (`threads` apart, which changes no bit).
struct ReferenceSettings {
    int width = 0;
    int height = 0;
    size_t camera = 0;  ///< index into CameraArrays
    uint64_t seed = 1;
    Strategies strategies = Strategies::mis;
    uint32_t max_depth = 0;  ///< scattering events, 1 is direct light; 0: no limit
    /// Only what light tracing sees: without light at infinity that the camera looks at, and without what it sees in
    /// mirrors and smooth glass.
    bool joinable_only = false;
    int threads = 0;         ///< 0: all
};

}  // namespace rtrays
