// SPDX-License-Identifier: MIT
// Quadric surfaces in object space: ray intersection, gradients and texture coordinates.
#pragma once

#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// The zero set of F = x^2 + y^2 + a z^2 + b z + c between two heights. It covers the sphere,
/// cylinder, cone, paraboloid and hyperboloid of ShapeArrays in their object spaces.
class Quadric {
  public:
    Quadric(ShapeArrays::Kind kind, double flare)
        : surface_(coefficients(kind, flare)), spherical_(kind == ShapeArrays::Kind::sphere) {}

    /// Finds the nearest t in (0, t_max) at which origin + t direction crosses the surface. Returns
    /// false if there is none.
    bool intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const;

    /// Returns the point of the surface nearest to `point`, which is off the surface by rounding
    /// only.
    Vec3 project(const Vec3 &point) const;

    /// Returns half the gradient of F. It points outwards or away from the axis.
    Vec3 gradient(const Vec3 &point) const {
        return {point.x(), point.y(), surface_.a * point.z() + 0.5 * surface_.b};
    }

    Eigen::Vector2d uv(const Vec3 &point) const;

    double low() const { return surface_.low; }
    double high() const { return surface_.high; }
    double radius() const { return surface_.radius; }  ///< greatest distance from the axis

  private:
    struct Coefficients {
        double a, b, c;
        double low, high;
        double radius;
    };
    static Coefficients coefficients(ShapeArrays::Kind kind, double flare);

    double value(const Vec3 &p) const {
        return square(p.x()) + square(p.y()) + (surface_.a * p.z() + surface_.b) * p.z() +
               surface_.c;
    }
    Coefficients surface_;
    bool spherical_;  ///< v follows the polar angle instead of the height
};

}  // namespace rtrays::reference
