// SPDX-License-Identifier: MIT
// Render settings that an exported scene file contains.
#pragma once

#include <cstdint>

namespace rtrays {

/// Render settings for the scene file of another renderer.
struct ExportSettings {
    uint64_t samples_per_pixel = 64;
    uint32_t max_depth = 0;  ///< maximum number of scattering events, 0 for no limit
};

}  // namespace rtrays
