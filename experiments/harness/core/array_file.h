// SPDX-License-Identifier: MIT
// Writes images as NumPy array files.
#pragma once

#include <filesystem>
#include <string>

#include "renderer/base/image.h"

namespace rtrays {

/// Writes the channels R, G, B of an image or of one of its layers as a NumPy array file (format
/// 1.0). The array has the shape (height, width, 3) and is float32, little-endian, with rows from
/// the top. The plots read this format, so that they need no EXR library. Throws `Error` (run
/// failed) and then leaves no partial file.
void write_array(const Image &image, const std::filesystem::path &path,
                 const std::string &layer = "");

}  // namespace rtrays
