// SPDX-License-Identifier: MIT
// Reading and writing of texture image files.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <utility>

#include "renderer/scene/stores.h"

namespace rtrays {

/// Encoding of the values of an image file. sRGB values are decoded to linear ones. `alpha` is the
/// alpha channel as a grey image; it is linear.
enum class TextureEncoding { srgb, linear, alpha };

/// Reads an image in any format of OpenImageIO (PNG, JPEG, TIFF, EXR, HDR, ...). Uses the channels
/// R, G and B, or one grey channel for all three, or the alpha channel. 8-bit images keep 8 bits,
/// all others become linear floats. Throws `Error` (bad input) naming the file if it is missing,
/// damaged or empty, or has other channels. Also throws if a value is negative or not finite, or if
/// a floating-point image is declared as sRGB.
std::shared_ptr<const TextureImage> load_texture_file(const std::filesystem::path &path,
                                                      TextureEncoding encoding);

/// Returns whether images of this name's extension store linear floats.
bool holds_floats(const std::filesystem::path &path);

/// Returns whether an image has an alpha channel. Throws `Error` (bad input) naming the file if it
/// cannot be read.
bool has_alpha_channel(const std::filesystem::path &path);

/// Loads the image module. Throws `Error` (bad input) naming `path` if this build has none.
void require_image_module(const std::filesystem::path &path);

/// Writes 8-bit RGB (3 * width * height values, rows from the top) as "png" or "jpeg". The file is
/// complete or absent. Throws `Error` (run failed) naming the file.
void write_image_bytes(const std::filesystem::path &path, const char *format, int width, int height,
                       const std::vector<uint8_t> &rgb);

/// Writes an image losslessly: 8-bit texels as PNG, floats as EXR. Throws `Error` (run failed)
/// naming the file.
void write_texture_file(const TextureImage &image, const std::filesystem::path &path);

/// Cache of image files. Loads each file once, however many textures use it.
class TextureFiles {
  public:
    /// Returns the cached image, or reads it by `load_texture_file`.
    std::shared_ptr<const TextureImage> load(const std::filesystem::path &path,
                                             TextureEncoding encoding);

    size_t loaded() const { return images_.size(); }

  private:
    std::map<std::pair<std::filesystem::path, TextureEncoding>, std::shared_ptr<const TextureImage>>
        images_;
};

}  // namespace rtrays
