// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// Linear colour of a texel, rows from the top; column and row must lie in the image.
Spectrum texel(const TextureImage &image, int column, int row);

/// A colour over the (u, v) plane (conventions: renderer/scene/stores.h). Bytes are decoded before
/// they are interpolated.
class Texture {
  public:
    /// Texture `index` of the store. Throws `Error` (bad input) for an image that is missing,
    /// empty, of another size than it states, or with values that are negative or not finite.
    Texture(const TextureArrays &textures, size_t index);

    Spectrum evaluate(const Eigen::Vector2d &uv) const;

  private:
    int wrap(int64_t i, int size) const;

    std::shared_ptr<const TextureImage> image_;
    TextureArrays::Filter filter_;
    TextureArrays::Wrap wrap_;
    Eigen::Vector2d scale_;
    Eigen::Vector2d offset_;
};

/// Throws `Error` (bad input) naming `what` unless the image is as `TextureImage` promises.
void require_valid(const TextureImage *image, const std::string &what);

}  // namespace rtrays::reference
