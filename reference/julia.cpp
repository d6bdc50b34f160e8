// SPDX-License-Identifier: MIT
#include "reference/julia.h"

#include <array>
#include <limits>

namespace rtrays::reference {

namespace {

using Quaternion = Eigen::Vector4d;  ///< (real, i, j, k)

constexpr double level = 4.0;

Quaternion squared(const Quaternion &q) {
    const Vec3 imaginary = q.tail<3>();
    Quaternion result;
    result << square(q[0]) - imaginary.squaredNorm(), 2.0 * q[0] * imaginary;
    return result;
}

/// Returns q d + d q, the derivative of q^2 along d.
Quaternion anticommutator(const Quaternion &q, const Quaternion &d) {
    Quaternion result;
    result << 2.0 * (q[0] * d[0] - q.tail<3>().dot(d.tail<3>())),
        2.0 * (q[0] * d.tail<3>() + d[0] * q.tail<3>());
    return result;
}

}  // namespace

JuliaSet::JuliaSet(const Eigen::Vector4d &constant, double slice, uint32_t iterations)
    : constant_(constant), slice_(slice), iterations_(iterations), escape_(iterations + 1) {
    // |z_k|^2 = |z_{k+1} - c| <= |z_{k+1}| + |c|.
    escape_[iterations] = level;
    for (uint32_t k = iterations; k > 0; --k) {
        escape_[k - 1] = std::sqrt(escape_[k] + constant.norm());
    }
    const double squared_radius = square(escape_[0]) - square(slice);
    // The bound is attained for real c and small n. The margin makes a ray start outside even then.
    radius_ = squared_radius > 0.0 ? 1.00001 * std::sqrt(squared_radius) : 0.0;
}

JuliaSet::Surroundings JuliaSet::look_around(const Vec3 &point) const {
    std::array<double, most_iterations + 1> moduli;
    Quaternion z = start(point);
    uint32_t k = 0;
    for (;; ++k) {
        moduli[k] = z.norm();
        // Stops at twice the escape radius, before anything can overflow.
        if (k == iterations_ || moduli[k] > 2.0 * escape_[k]) {
            break;
        }
        z = squared(z) + constant_;
    }
    const bool outside = moduli[k] > escape_[k];
    double radius = std::abs(moduli[k] - escape_[k]);
    while (k > 0) {
        --k;
        // sqrt(|z|^2 + e) - |z| without cancellation. The fraction would be 0 / 0 if both are 0.
        const double sum = std::sqrt(square(moduli[k]) + radius) + moduli[k];
        radius = sum > 0.0 ? radius / sum : 0.0;
    }
    return {outside, radius};
}

bool JuliaSet::intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const {
    // The ray is marched from where it enters the bounding sphere to where it leaves the sphere.
    const double speed = direction.norm();
    const double middle = -origin.dot(direction) / square(speed);
    const double reach_squared = square(radius_) - (origin + middle * direction).squaredNorm();
    if (!(reach_squared > 0.0)) {
        return false;
    }
    const double half = std::sqrt(reach_squared) / speed;
    const double end = std::min(middle + half, t_max);
    double at = std::max(middle - half, 0.0);
    if (!(at < end)) {
        return false;
    }
    Surroundings here = look_around(origin + at * direction);
    const bool outside = here.outside;
    while (at < end) {
        const double before = at;
        at = std::min(at + std::max(here.radius, least_step) / speed, end);
        here = look_around(origin + at * direction);
        if (here.outside == outside) {
            continue;
        }
        double low = before, high = at;
        for (;;) {
            const double mid = 0.5 * (low + high);
            if (!(mid > low && mid < high)) {
                break;  // low and high are neighbours in double
            }
            (look_around(origin + mid * direction).outside == outside ? low : high) = mid;
        }
        t = high;
        return t > 0.0 && t < t_max;
    }
    return false;
}

double JuliaSet::modulus(const Vec3 &point) const {
    Quaternion z = start(point);
    for (uint32_t k = 0; k < iterations_; ++k) {
        if (z.norm() > 2.0 * escape_[k]) {
            return std::numeric_limits<double>::infinity();
        }
        z = squared(z) + constant_;
    }
    return z.norm();
}

Vec3 JuliaSet::normal(const Vec3 &point) const {
    Quaternion z = start(point);
    std::array<Quaternion, 3> derivative{Quaternion::UnitX(), Quaternion::UnitY(),
                                         Quaternion::UnitZ()};
    for (uint32_t k = 0; k < iterations_; ++k) {
        double largest = 0.0;
        for (Quaternion &d : derivative) {
            d = anticommutator(z, d);
            largest = std::max(largest, d.cwiseAbs().maxCoeff());
        }
        // Only the ratios matter. Without scaling, 64 iterations near |z| = 2 would reach 2^128.
        for (Quaternion &d : derivative) {
            d /= largest;
        }
        z = squared(z) + constant_;
    }
    return Vec3(z.dot(derivative[0]), z.dot(derivative[1]), z.dot(derivative[2])).normalized();
}

}  // namespace rtrays::reference
