// SPDX-License-Identifier: MIT
// Quaternion Julia sets: ray intersection and normals in double.
#pragma once

#include <vector>

#include "reference/math.h"

namespace rtrays::reference {

/// Quaternion Julia set: the level set |z_n| = 4 of z <- z^2 + c, sliced at z_0 = (x, y, z, slice)
/// (Hart, Sandin & Kauffman 1989, "Ray Tracing Deterministic 3-D Fractals"). The inside is |z_n| <
/// 4.
///
/// Rays are marched with steps that provably do not cross the surface. Their bound replaces Hart's
/// distance estimate. Let z_k move by less than e. Then z_{k+1} moves by less than 2 |z_k| e + e^2,
/// since |z d + d z + d^2| <= 2 |z| |d| + |d|^2. Backwards, z_{k+1} moves by less than e' if z_k
/// moves by less than sqrt(|z_k|^2 + e') - |z_k|. Starting from e' = ||z_n| - 4|, this recursion
/// gives a radius around z_0 in which |z_n| does not cross 4.
class JuliaSet {
  public:
    /// `constant`: c as (real, i, j, k). `iterations`: n, from 1 to `most_iterations`.
    JuliaSet(const Eigen::Vector4d &constant, double slice, uint32_t iterations);

    static constexpr uint32_t most_iterations = 64;

    /// Finds the nearest t in (0, t_max) at which origin + t direction crosses the surface. Returns
    /// false if there is none. The point satisfies the level set to the precision of double. The
    /// surface may be missed where the ray is behind it for less than `least_step` of its length.
    bool intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const;

    /// Returns |z_n|, or infinity once an iterate is so large that it must escape.
    double modulus(const Vec3 &point) const;

    /// Returns the gradient of |z_n| at a point of the surface, scaled to unit length. It points
    /// outwards.
    Vec3 normal(const Vec3 &point) const;

    /// Returns the radius of a sphere around the origin that encloses the surface, or 0 if the
    /// slice misses the surface.
    double bounding_radius() const { return radius_; }

    static constexpr double least_step = 1e-7;  ///< smallest marching step in object units

  private:
    struct Surroundings {
        bool outside;
        double radius;  ///< radius of a ball that does not meet the surface
    };
    Surroundings look_around(const Vec3 &point) const;
    Eigen::Vector4d start(const Vec3 &point) const {
        return {point.x(), point.y(), point.z(), slice_};
    }

    Eigen::Vector4d constant_;
    double slice_;
    uint32_t iterations_;
    std::vector<double> escape_;  ///< |z_k| > escape_[k] implies |z_n| > 4
    double radius_;
};

}  // namespace rtrays::reference
