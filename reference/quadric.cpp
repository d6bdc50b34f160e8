// SPDX-License-Identifier: MIT
#include "reference/quadric.h"

#include <algorithm>

#include "renderer/base/error.h"

namespace rtrays::reference {

Quadric::Coefficients Quadric::coefficients(ShapeArrays::Kind kind, double flare) {
    switch (kind) {
        case ShapeArrays::Kind::sphere:
            return {1, 0, -1, -1, 1, 1};
        case ShapeArrays::Kind::cylinder:
            return {0, 0, -1, 0, 1, 1};
        case ShapeArrays::Kind::cone:  // (1 - z)^2 = 1 - 2 z + z^2
            return {-1, 2, -1, 0, 1, 1};
        case ShapeArrays::Kind::paraboloid:
            return {0, -1, 0, 0, 1, 1};
        case ShapeArrays::Kind::hyperboloid:
            return {-flare, 0, -1, -1, 1, std::sqrt(1.0 + flare)};
        default:
            throw run_error("the shape is not a quadric");
    }
}

bool Quadric::intersect(const Vec3 &origin, const Vec3 &direction, double t_max, double &t) const {
    // Far away, F(origin) cancels against the other terms. The equation is then solved for the
    // distance from the point of the ray nearest to the object's origin. Nearby, where rays leave
    // the surface itself, the origin is not moved. The sign of F(origin), which depends on the side
    // of the surface, then decides the signs of the roots.
    const double shift = origin.squaredNorm() > 16.0 * (1.0 + square(surface_.radius))
                             ? -origin.dot(direction) / direction.squaredNorm()
                             : 0.0;
    const Vec3 o = origin + shift * direction;
    const double a =
        square(direction.x()) + square(direction.y()) + surface_.a * square(direction.z());
    const double half_b = gradient(o).dot(direction);
    const double c = value(o);
    const double discriminant = square(half_b) - a * c;
    if (!(discriminant >= 0.0)) {
        return false;
    }
    // Both roots are computed without cancellation. Along a generator of the surface, a is 0 and
    // one root is infinite or 0 / 0. The comparisons below exclude it.
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    const double root1 = q / a, root2 = c / q;
    bool found = false;
    for (const double root : {root1, root2}) {
        const double candidate = root + shift;
        const double z = origin.z() + candidate * direction.z();
        // A sphere has no ends, so rounding must not open it at the poles.
        if (candidate > 0.0 && candidate < t_max &&
            (spherical_ || (z >= surface_.low && z <= surface_.high))) {
            t = t_max = candidate;
            found = true;
        }
    }
    return found;
}

Vec3 Quadric::project(const Vec3 &point) const {
    const Vec3 slope = 2.0 * gradient(point);
    const double squared = slope.squaredNorm();
    // One Newton step, but none at the apex of a cone.
    return squared > 1e-20 ? Vec3(point - value(point) / squared * slope) : point;
}

Eigen::Vector2d Quadric::uv(const Vec3 &point) const {
    const double phi = std::atan2(point.y(), point.x());
    const double u = (phi < 0.0 ? phi + 2.0 * pi : phi) / (2.0 * pi);
    if (spherical_) {
        // Equals acos(z) for a unit vector, without its loss of digits at the poles.
        const double theta = std::atan2(std::hypot(point.x(), point.y()), point.z());
        return {u, 1.0 - theta / pi};
    }
    return {u, (point.z() - surface_.low) / (surface_.high - surface_.low)};
}

}  // namespace rtrays::reference
