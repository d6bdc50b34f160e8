// SPDX-License-Identifier: MIT
// Vector and colour types, constants and orthonormal frames of the reference.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "renderer/base/angles.h"

namespace rtrays::reference {

using Vec3 = Eigen::Vector3d;
using Spectrum = Eigen::Array3d;  ///< linear Rec. 709, one value per channel

constexpr double inv_pi = 1.0 / pi;

inline double square(double x) {
    return x * x;
}

/// Orthonormal frame whose z axis is a given unit normal (Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited", listing 3). The construction has no branch and no cancellation
/// near the poles.
class Frame {
  public:
    explicit Frame(const Vec3 &normal) : z_(normal) {
        const double sign = std::copysign(1.0, normal.z());
        const double a = -1.0 / (sign + normal.z());
        const double b = normal.x() * normal.y() * a;
        x_ = {1.0 + sign * square(normal.x()) * a, sign * b, -sign * normal.x()};
        y_ = {b, sign + square(normal.y()) * a, -normal.y()};
    }

    /// Aligns the x axis with the part of `tangent` (any length) that is in the plane. The x axis
    /// is arbitrary if the tangent is zero or parallel to the normal.
    Frame(const Vec3 &normal, const Vec3 &tangent) : Frame(normal) {
        const Vec3 in_plane = tangent - tangent.dot(normal) * normal;
        const double length = in_plane.norm();
        // A length below 1e-8 of the tangent is rounding error. NaN fails the comparison as well.
        if (length > 1e-8 * tangent.norm()) {
            x_ = in_plane / length;
            y_ = z_.cross(x_);
        }
    }

    const Vec3 &x() const { return x_; }
    const Vec3 &z() const { return z_; }

    Vec3 to_local(const Vec3 &v) const { return {x_.dot(v), y_.dot(v), z_.dot(v)}; }
    Vec3 to_world(const Vec3 &v) const { return v.x() * x_ + v.y() * y_ + v.z() * z_; }

  private:
    Vec3 x_, y_, z_;
};

}  // namespace rtrays::reference
