// SPDX-License-Identifier: MIT
// Shapes in extended precision, written from their definitions in ShapeArrays. They judge the
// device's results and are independent of ShapeRecord.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "renderer/scene/stores.h"
#include "renderer/shared/compat.h"

namespace rtrays::test {

using Kind = ShapeArrays::Kind;
using Real = long double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Random = std::mt19937_64;

inline double uniform(Random &random, double lower = 0, double upper = 1) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
}

/// Returns 10^x with x uniform in [lower, upper].
inline double log_uniform(Random &random, double lower, double upper) {
    return std::pow(10.0, uniform(random, lower, upper));
}

inline Eigen::Vector3d uniform_direction(Random &random) {
    const double z = uniform(random, -1, 1), phi = uniform(random, 0, 2 * M_PI),
                 r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

inline Eigen::Matrix3d uniform_rotation(Random &random) {
    std::normal_distribution<double> normal;
    return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
        .normalized()
        .toRotationMatrix();
}

/// Rounds to float. Must not be inlined: GCC 12 replaces (double)(float)x with x once it has
/// vectorized two components, but the judge must see the same ray as the device.
[[gnu::noinline]] inline float3 to_float3(const Eigen::Vector3d &v) {
    return make_float3(static_cast<float>(v.x()), static_cast<float>(v.y()),
                       static_cast<float>(v.z()));
}

inline Eigen::Vector3d to_double(float3 v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// One shape, as ShapeArrays defines it.
struct Shape {
    Kind kind = Kind::sphere;
    Eigen::Matrix4d world_from_object = Eigen::Matrix4d::Identity();
    double flare = 0;

    Eigen::Matrix3d linear() const { return world_from_object.topLeftCorner<3, 3>(); }
    Eigen::Vector3d centre() const { return world_from_object.topRightCorner<3, 1>(); }

    /// Returns the length that scales rounding errors of world coordinates: size of the shape plus
    /// size of its coordinates.
    double scale() const {
        return linear().cwiseAbs().rowwise().sum().maxCoeff() * std::sqrt(1 + flare) +
               centre().norm();
    }

    /// Returns the norm of |inverse| |linear part|, the factor by which transforms back and forth
    /// magnify rounding errors.
    double condition() const {
        return (linear().inverse().cwiseAbs() * linear().cwiseAbs()).rowwise().sum().maxCoeff();
    }

    /// Returns the implicit function: zero on the unclipped surface, positive in front of it.
    Real value(const Vector3r &p) const {
        const Real r2 = p.x() * p.x() + p.y() * p.y(), z = p.z();
        switch (kind) {
            case Kind::sphere:
                return r2 + z * z - 1;
            case Kind::cylinder:
                return r2 - 1;
            case Kind::cone:
                return r2 - (1 - z) * (1 - z);
            case Kind::paraboloid:
                return r2 - z;
            case Kind::hyperboloid:
                return r2 - 1 - static_cast<Real>(flare) * z * z;
            default:
                return z;
        }
    }

    Vector3r gradient(const Vector3r &p) const {
        switch (kind) {
            case Kind::sphere:
                return 2 * p;
            case Kind::cylinder:
                return {2 * p.x(), 2 * p.y(), 0};
            case Kind::cone:
                return {2 * p.x(), 2 * p.y(), 2 * (1 - p.z())};
            case Kind::paraboloid:
                return {2 * p.x(), 2 * p.y(), -1};
            case Kind::hyperboloid:
                return {2 * p.x(), 2 * p.y(), -2 * static_cast<Real>(flare) * p.z()};
            default:
                return {0, 0, 1};
        }
    }

    bool clipped(const Vector3r &p) const {
        switch (kind) {
            case Kind::cylinder:
            case Kind::cone:
            case Kind::paraboloid:
                return p.z() < 0 || p.z() > 1;
            case Kind::hyperboloid:
                return p.z() < -1 || p.z() > 1;
            case Kind::disc:
                return p.x() * p.x() + p.y() * p.y() > 1;
            default:
                return false;
        }
    }

    Vector3r to_object(const Eigen::Vector3d &world) const {
        return linear().cast<Real>().inverse() * (world - centre()).cast<Real>();
    }

    /// Returns a random point on the surface. The density is not uniform but covers all parts.
    Eigen::Vector3d surface_point(Random &random) const {
        const double phi = uniform(random, 0, 2 * M_PI), h = uniform(random);
        const auto ring = [&](double r, double z) {
            return Eigen::Vector3d(r * std::cos(phi), r * std::sin(phi), z);
        };
        switch (kind) {
            case Kind::sphere:
                return uniform_direction(random);
            case Kind::cylinder:
                return ring(1, h);
            case Kind::cone:
                return ring(1 - h, h);
            case Kind::paraboloid:
                return ring(std::sqrt(h), h);
            case Kind::hyperboloid:
                return ring(std::sqrt(1 + flare * (2 * h - 1) * (2 * h - 1)), 2 * h - 1);
            case Kind::disc:
                return ring(h, 0);
            default:
                return ring(10 * h, 0);
        }
    }
};

/// Coefficients of A t^2 + 2 B t + C, the implicit function along a ray.
struct RayQuadratic {
    Real a, b, c;
};

inline RayQuadratic along_ray(const Shape &shape, const Vector3r &o, const Vector3r &d) {
    if (shape.kind == Kind::disc || shape.kind == Kind::plane) {
        return {0, d.z() / 2, o.z()};
    }
    // The function is quadratic, so three values determine it exactly.
    const Real at_0 = shape.value(o), at_1 = shape.value(o + d), at_minus_1 = shape.value(o - d);
    return {(at_1 + at_minus_1) / 2 - at_0, (at_1 - at_minus_1) / 4, at_0};
}

/// Returns the distances of all hits at t > 0 in ascending order.
inline std::vector<double> hits(const Shape &shape, const Eigen::Vector3d &origin,
                                const Eigen::Vector3d &direction) {
    const Vector3r d = shape.linear().cast<Real>().inverse() * direction.cast<Real>();
    // Solving about the point nearest to the object's origin limits the loss of precision.
    const Vector3r o = shape.to_object(origin);
    const Real shift = shape.kind == Kind::plane ? 0 : -o.dot(d) / d.squaredNorm();
    const Vector3r unit = d / d.norm(), near = o + shift * d;
    const auto [a, b, c] = along_ray(shape, near, unit);
    std::vector<double> found;
    const auto add = [&](Real s) {
        const Real t = shift + s / d.norm();
        const Vector3r p = near + s * unit;
        if (std::isfinite(t) && t > 0 && !shape.clipped(p)) {
            found.push_back(static_cast<double>(t));
        }
    };
    const Real discriminant = b * b - a * c;
    if (discriminant >= 0) {
        const Real w = -(b + std::copysign(std::sqrt(discriminant), b));
        add(c / w);
        if (a != 0) {
            add(w / a);
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// Returns whether a ray whose first hit is at `t` (infinite for a miss) overlooked nothing: some
/// ray within `tolerance` (a length) of it has no hit before `t` either. The caller must check that
/// the hit itself is right, that is, its point is on the surface and on the ray.
inline bool nothing_before(const Shape &shape, const Eigen::Vector3d &origin,
                           const Eigen::Vector3d &direction, double t, double tolerance,
                           Random &random) {
    const double slack = tolerance / direction.norm() + (std::isfinite(t) ? 1e-6 * t : 0);
    const auto holds = [&](const Eigen::Vector3d &o) {
        const std::vector<double> all = hits(shape, o, direction);
        // A hit at the origin itself may count or not.
        return std::none_of(all.begin(), all.end(),
                            [&](double hit) { return hit > slack && hit < t - slack; });
    };
    if (holds(origin)) {
        return true;
    }
    // The shifts are perpendicular to the clipping planes, perpendicular to the surface where the
    // ray is nearest to it, and random.
    const Eigen::Matrix3d inverse_transpose = shape.linear().inverse().transpose();
    const Vector3r o = shape.to_object(origin),
                   d = shape.linear().cast<Real>().inverse() * direction.cast<Real>();
    const Eigen::Vector3d g = shape.gradient(o - o.dot(d) / d.squaredNorm() * d).cast<double>();
    std::vector<Eigen::Vector3d> shifts = {inverse_transpose.col(2).normalized(),
                                           (inverse_transpose * g).normalized()};
    for (int i = 0; i < 60; ++i) {
        shifts.push_back(uniform_direction(random) * uniform(random));
    }
    return std::any_of(shifts.begin(), shifts.end(), [&](const Eigen::Vector3d &shift) {
        return holds(origin + tolerance * shift) || holds(origin - tolerance * shift);
    });
}

}  // namespace rtrays::test
