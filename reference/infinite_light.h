// SPDX-License-Identifier: MIT
// Lights at infinity: the uniform dome and the environment map. A path hits them by leaving the
// scene. Besides the members of area lights (area_light.h) they have:
//
//     Spectrum radiance(direction)
//         Radiance arriving from the direction.
//     double pdf_w(direction)
//         Density of `sample` per solid angle.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "reference/delta_light.h"
#include "reference/light_sample.h"
#include "reference/sampling.h"

namespace rtrays::reference {

/// The same radiance from every direction. Directions are uniform over the sphere.
class DomeLight : public Unhittable {
  public:
    using Unhittable::pdf_w;

    DomeLight(const Spectrum &radiance, double scene_radius)
        : radiance_(radiance), scene_radius_(scene_radius) {}

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    Spectrum radiance(const Vec3 &) const { return radiance_; }
    double pdf_w(const Vec3 &) const { return 0.25 * inv_pi; }

    /// Returns the power into the scene's bounding sphere: 4 pi L times the area of its disc.
    double power() const { return 4.0 * square(pi * scene_radius_) * radiance_.mean(); }

  private:
    Spectrum radiance_;
    double scene_radius_;
};

/// Environment map, a latitude-longitude image (conventions: renderer/scene/stores.h).
///
/// Sampling follows the interpolated image. A cell is the region between four texel centres. It is
/// selected by the mean over its corners and the channels, times the mean sine of its latitudes.
/// Within the cell, the density follows the bilinear interpolant exactly. Therefore the density is
/// zero only where the image is black.
class EnvironmentLight : public Unhittable {
  public:
    using Unhittable::pdf_w;

    /// `rotation`: world from light. Throws `Error` (bad input) naming `what` if the image is
    /// missing or invalid.
    EnvironmentLight(std::shared_ptr<const TextureImage> image, const Eigen::Matrix3d &rotation,
                     const Spectrum &factor, double scene_radius, const std::string &what);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    Spectrum radiance(const Vec3 &direction) const;
    double pdf_w(const Vec3 &direction) const;
    double power() const { return 4.0 * square(pi * scene_radius_) * mean_radiance_; }

  private:
    /// Position of an image point among the surrounding texel centres.
    struct Cell {
        int column;  ///< column of the left centres; the right ones are in the next, wrapped
        int row;     ///< row of the lower centres, 0 to height; the upper ones are in the row above
        double right, down;  ///< offsets from the upper left corner, in [0, 1]
    };
    bool is_black() const { return !(mean_radiance_ > 0.0); }
    Cell cell_of(double u, double v) const;
    Spectrum corner(int column, int row) const;  ///< texel, with column wrapped and row clamped
    Spectrum interpolate(const Cell &cell) const;
    double top(int row) const;  ///< v of the upper edge of a row of cells
    /// Returns the means over the channels at the four corners, upper left first, row by row.
    std::array<double, 4> corners(const Cell &cell) const;
    Eigen::Vector2d to_image(const Vec3 &direction_in_light) const;

    std::shared_ptr<const TextureImage> image_;
    Eigen::Matrix3d rotation_;
    Spectrum factor_;
    double scene_radius_;
    double mean_radiance_ = 0.0;  ///< mean over the sphere and the channels
    AliasTable choose_;           ///< selects a cell, row by row; empty if the image is black
};

}  // namespace rtrays::reference
