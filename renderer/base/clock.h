// SPDX-License-Identifier: MIT
// Wall-clock time.
#pragma once

#include <chrono>

namespace rtrays {

using SteadyClock = std::chrono::steady_clock;

/// Returns the seconds that have passed since `start`.
inline double seconds_since(SteadyClock::time_point start) {
    return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

}  // namespace rtrays
