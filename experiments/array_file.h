// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "renderer/base/image.h"

namespace rtrays {

/// Writes R, G, B, or those of a layer, as a NumPy array file (format 1.0): shape (height, width,
/// 3), float32, little-endian, rows from the top. The plots read this and need no library for EXR.
/// Whole or not at all: throws `Error` (run failed).
void write_array(const Image &image, const std::filesystem::path &path,
                 const std::string &layer = "");

}  // namespace rtrays
