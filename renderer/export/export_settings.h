// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace rtrays {

/// What the scene file of another renderer says besides the scene.
struct ExportSettings {
    uint64_t samples_per_pixel = 64;
    uint32_t max_depth = 0;  ///< as ours: scattering events, 0 for no limit
};

}  // namespace rtrays
