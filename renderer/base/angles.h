// SPDX-License-Identifier: MIT
// pi, and degrees in radians.
#pragma once

namespace rtrays {

inline constexpr double pi = 3.14159265358979323846;

/// One degree in radians.
inline constexpr double degree = pi / 180;

}  // namespace rtrays
