// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "reference/math.h"

namespace rtrays::reference {

/// The level set |z_n| = 4 of z <- z^2 + c over the quaternions, sliced at z_0 = (x, y, z, slice)
/// (Hart, Sandin & Kauffman 1989, "Ray Tracing Deterministic 3-D Fractals"). Inside is |z_n| < 4.
///
/// Rays are marched with steps that provably do not cross the surface, from a bound of our own
/// instead of Hart's distance estimate: let z_k move by less than e. Then z_{k+1} moves by less
/// than 2 |z_k| e + e^2, since |z d + d z + d^2| <= 2 |z| |d| + |d|^2. Backwards, z_{k+1} stays
/// within e' as long as z_k stays within sqrt(|z_k|^2 + e') - |z_k|. Starting from e' = ||z_n| - 4|
/// this gives a radius around z_0 in which |z_n| does not pass 4.
class JuliaSet {
  public:
    /// `constant`: c as (real, i, j, k); `iterations`: n, from 1 to `most_iterations`.
    JuliaSet(const Eigen::Vector4d &constant, double slice, uint32_t iterations);

    static constexpr uint32_t most_iterations = 64;

    /// Nearest t in (0, t_max) at which origin + t direction crosses the surface; false when there
    /// is none. The point found satisfies the level set as exactly as double can tell. Where the
    /// ray dips through the surface by less than `least_step` (over |direction|) of its length it
    /// may be missed.
    bool intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const;

    /// |z_n|, or infinity once an iterate is so large that it must escape.
    double modulus(const Vec3 &point) const;

    /// Gradient of |z_n| at a point of the surface, scaled to unit length: outwards.
    Vec3 normal(const Vec3 &point) const;

    /// Radius of a sphere around the origin that encloses the surface; 0 when the slice misses it.
    double bounding_radius() const { return radius_; }

    static constexpr double least_step = 1e-7;  ///< object units

  private:
    struct Surroundings {
        bool outside;
        double radius;  ///< of the ball in which nothing is crossed
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
