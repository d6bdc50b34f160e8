// SPDX-License-Identifier: MIT
// Lights at infinity. Besides the members of area lights (which they cannot be hit by, but by
// leaving the scene) they have
//
//     Spectrum radiance(direction)   arriving from there
//     double pdf_w(direction)        density of sample() per solid angle
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "reference/delta_light.h"
#include "reference/light_sample.h"
#include "reference/sampling.h"

namespace rtrays::reference {

/// The same radiance from everywhere; directions are uniform over the sphere.
class DomeLight : public Unhittable {
  public:
    using Unhittable::pdf_w;

    DomeLight(const Spectrum &radiance, double scene_radius)
        : radiance_(radiance), scene_radius_(scene_radius) {}

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    Spectrum radiance(const Vec3 &) const { return radiance_; }
    double pdf_w(const Vec3 &) const { return 0.25 * inv_pi; }

    /// Into the scene's bounding sphere: 4 pi L times its disc.
    double power() const { return 4.0 * square(pi * scene_radius_) * radiance_.mean(); }

  private:
    Spectrum radiance_;
    double scene_radius_;
};

/// A latitude-longitude image (conventions: renderer/scene/stores.h).
///
/// Directions are drawn from the image as it is interpolated: the cells between four texel centres
/// are chosen by the mean of their corners (and channels) times the mean sine of their latitudes;
/// in a cell the density follows the bilinear interpolant exactly, so that it is zero nowhere but
/// where the image is black.
class EnvironmentLight : public Unhittable {
  public:
    using Unhittable::pdf_w;

    /// `rotation`: world from light. Throws `Error` (bad input) naming `what` when there is no
    /// float image.
    EnvironmentLight(std::shared_ptr<const TextureImage> image, const Eigen::Matrix3d &rotation,
                     const Spectrum &factor, double scene_radius, const std::string &what);

    std::optional<LightSample> sample(const Geometry &geometry, const Vec3 &from, Rng &rng) const;
    Spectrum radiance(const Vec3 &direction) const;
    double pdf_w(const Vec3 &direction) const;
    double power() const { return 4.0 * square(pi * scene_radius_) * mean_radiance_; }

  private:
    /// Where an image point lies among the texel centres around it.
    struct Cell {
        int column;  ///< of the left centres; the right ones are the next, wrapped
        int row;     ///< of the lower centres, 0 to height: the upper ones are the row before
        double right, down;  ///< from the upper left corner, in [0, 1]
    };
    bool is_black() const { return !(mean_radiance_ > 0.0); }
    Cell cell_of(double u, double v) const;
    Spectrum corner(int column, int row) const;  ///< wrapped and clamped
    Spectrum interpolate(const Cell &cell) const;
    double top(int row) const;  ///< v of the upper edge of a row of cells
    /// Means over the channels at the four corners, upper left first, row by row.
    std::array<double, 4> corners(const Cell &cell) const;
    Eigen::Vector2d to_image(const Vec3 &direction_in_light) const;

    std::shared_ptr<const TextureImage> image_;
    Eigen::Matrix3d rotation_;
    Spectrum factor_;
    double scene_radius_;
    double mean_radiance_ = 0.0;  ///< over the sphere
    AliasTable choose_;           ///< of cells, by rows; empty when all is black
};

}  // namespace rtrays::reference
