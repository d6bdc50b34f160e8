// SPDX-License-Identifier: MIT
// Interface of the image module, a shared library that is loaded when the first image is read.
// OpenImageIO pulls in more than two hundred shared libraries, which cost every program that links
// it 0.2 s and 130 MB at start. Only the module links it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace rtrays {

/// The channels of an image file that a texture uses.
enum class ImageChannels { colours, alpha };

/// Channels of an image file as stored: three per texel, top row first. Alpha is stored three
/// times.
struct RawImage {
    int width = 0;
    int height = 0;
    bool is_floating = false;    ///< the file stores floating-point numbers
    std::vector<uint8_t> bytes;  ///< texels of an 8-bit file, otherwise empty
    std::vector<float> floats;   ///< texels of any other file, integers scaled to [0, 1]
};

/// Signatures of the functions that the module exports. `load_texture_file` and
/// `write_texture_file` document the errors they throw.
using ReadImageFile = void(const std::filesystem::path &path, ImageChannels channels,
                           RawImage &image);
using HasAlphaChannel = bool(const std::filesystem::path &path);
using WriteImageFile = void(const std::filesystem::path &path, const char *format, int width,
                            int height, const uint8_t *rgb);
constexpr const char *image_module_name = "librtrays_images.so";
constexpr const char *read_image_file_name = "rtrays_read_image_file";
constexpr const char *has_alpha_channel_name = "rtrays_has_alpha_channel";
constexpr const char *write_image_file_name = "rtrays_write_image_file";

}  // namespace rtrays
