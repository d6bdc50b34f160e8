// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <utility>

#include "renderer/scene/stores.h"

namespace rtrays {

/// How the numbers of an image file stand for linear values.
enum class TextureEncoding { srgb, linear };

/// Reads an image (PNG, JPEG, TIFF, EXR, HDR, ... as OpenImageIO does): the channels R, G and B, or
/// one grey one for all three; alpha is dropped. 8 bits stay 8 bits, everything else becomes linear
/// floats. Throws `Error` (bad input) naming the file when it is missing, damaged or empty, has
/// other channels, values that are negative or not finite, or is of floats and said to be sRGB.
std::shared_ptr<const TextureImage> load_texture_file(const std::filesystem::path &path,
                                                      TextureEncoding encoding);

/// Writes an image that reads back the same: one of 8 bits as PNG, one of floats as
/// EXR. Throws `Error` (run failed) naming the file.
void write_texture_file(const TextureImage &image, const std::filesystem::path &path);

/// Loads each file once, however many textures use it.
class TextureFiles {
  public:
    /// As `load_texture_file`.
    std::shared_ptr<const TextureImage> load(const std::filesystem::path &path,
                                             TextureEncoding encoding);

    size_t loaded() const { return images_.size(); }

  private:
    std::map<std::pair<std::filesystem::path, TextureEncoding>, std::shared_ptr<const TextureImage>>
        images_;
};

}  // namespace rtrays
