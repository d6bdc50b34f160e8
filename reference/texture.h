// SPDX-License-Identifier: MIT
// Texture look-ups in double precision.
#pragma once

#include <memory>

#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// Returns the linear colour of a texel. Rows start at the top; column and row must be in the
/// image.
Spectrum texel(const TextureImage &image, int column, int row);

/// Returns the Rec. 709 luminance of a linear colour. For a grey, this is exactly its value.
double luminance(const Spectrum &colour);

/// Where a surface looks up its textures. Implicit from coordinates, without colours of vertices.
struct TexturePoint {
    TexturePoint(const Eigen::Vector2d &coordinates)  // NOLINT: the conversion is meant
        : uv(coordinates) {}
    TexturePoint(const Eigen::Vector2d &coordinates, const Spectrum &colour)
        : uv(coordinates), vertex_colour(colour) {}

    Eigen::Vector2d uv;
    Spectrum vertex_colour = Spectrum::Ones();  ///< interpolated between vertices
};

/// A colour over the (u, v) plane (conventions: renderer/scene/stores.h). Bytes are decoded before
/// interpolation.
class Texture {
  public:
    /// Uses texture `index` of the store. Throws `Error` (bad input) for an image that is missing
    /// or empty, differs from its stated size, or has values that are negative or not finite.
    Texture(const TextureArrays &textures, size_t index);

    /// Returns the linear colour, multiplied by that of the vertices if the texture has these.
    Spectrum evaluate(const TexturePoint &at) const;

    /// Returns the derivatives of the Rec. 709 luminance by u and v; zero for the filter `nearest`.
    Eigen::Vector2d luminance_gradient(const Eigen::Vector2d &uv) const;
    /// Returns the mean of all texels.
    Spectrum mean() const;

  private:
    /// The texels around a point for bilinear interpolation.
    struct Cell {
        Spectrum lower_left, lower_right, upper_left, upper_right;
        double right, up;  ///< position of the point between the texels
    };
    Spectrum image_colour(const Eigen::Vector2d &uv) const;
    Cell cell(const Eigen::Vector2d &uv) const;
    Spectrum look_up(double column, double row_from_below) const;
    Eigen::Vector2d texel_coordinates(const Eigen::Vector2d &uv) const;
    int wrap(int64_t i, int size) const;

    std::shared_ptr<const TextureImage> image_;
    TextureArrays::Filter filter_;
    TextureArrays::Wrap wrap_;
    Eigen::Vector2d scale_;
    Eigen::Vector2d offset_;
    bool has_vertex_colours_;
};

/// Checks that the image satisfies the description of `TextureImage`. Throws `Error` (bad input)
/// naming `what` if it does not.
void require_valid(const TextureImage *image, const std::string &what);

}  // namespace rtrays::reference
