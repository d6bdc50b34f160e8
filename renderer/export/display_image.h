// SPDX-License-Identifier: MIT
// Image outputs by file name: linear OpenEXR with all layers, or an 8-bit sRGB display image.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "renderer/base/image.h"

namespace rtrays {

/// Encodes the colours of an image for a display: 3 * width * height values, rows from the top.
/// A value is 255 times the sRGB curve of 2^exposure times the radiance, rounded. Radiance above
/// 2^-exposure becomes white, negative radiance and NaN become black. The clipping concerns the
/// display image alone.
std::vector<uint8_t> display_bytes(const Image &image, double exposure);

/// Checks an output name before there is an image. Throws `Error` (bad input) unless the name ends
/// in .exr, .png, .jpg or .jpeg, the file can be created, and this build can write the format.
void require_image_output(const std::filesystem::path &path);

/// Writes an EXR (`write_exr`), or the display image that the name asks for. The file is complete
/// or absent. Throws `Error` (run failed) naming the file.
void write_image(const Image &image, const std::filesystem::path &path, double exposure);

}  // namespace rtrays
