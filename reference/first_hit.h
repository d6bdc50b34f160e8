// SPDX-License-Identifier: MIT
// Classes of pixels by what the camera sees first: lights behind mirrors or glass, other mirrors
// and glass, and the rest. They depend on the scene and the camera alone, not on an estimator.
#pragma once

#include <array>
#include <cstdint>

namespace rtrays {

/// Class of a pixel. Paths of the first class connect the camera with a light by delta events
/// alone, so that no strategy but hitting the light finds them.
enum class FirstHit : uint8_t { light_behind_delta, delta, other };

/// Names of the classes, by their values.
constexpr std::array<const char *, 3> first_hit_names{"light_behind_delta", "delta", "other"};

}  // namespace rtrays
