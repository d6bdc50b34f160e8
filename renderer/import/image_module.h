// SPDX-License-Identifier: MIT
// OpenImageIO brings more than two hundred shared libraries with it: 0.2 s and 130 MB for every
// start of a program that links it. So it lives in a module beside the programs that is opened when
// the first image is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace rtrays {

/// The colour channels of an image file as read: three each, rows from the top.
struct RawImage {
    int width = 0;
    int height = 0;
    bool is_floating = false;    ///< the file holds floating-point numbers
    std::vector<uint8_t> bytes;  ///< of a file of 8 bits; or empty
    std::vector<float> floats;   ///< of any other; integers are scaled to [0, 1]
};

/// The functions of the module: see `load_texture_file` and `write_texture_file` for what they
/// throw.
using ReadImageFile = void(const std::filesystem::path &path, RawImage &image);
using WriteImageFile = void(const std::filesystem::path &path, int width, int height,
                            const uint8_t *rgb);
constexpr const char *image_module_name = "librtrays_images.so";
constexpr const char *read_image_file_name = "rtrays_read_image_file";
constexpr const char *write_image_file_name = "rtrays_write_image_file";

}  // namespace rtrays
