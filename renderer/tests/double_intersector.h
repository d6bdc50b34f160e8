// SPDX-License-Identifier: MIT
// Brute force in double precision: the judge of what traversal finds.
#pragma once

#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/tests/bvh_meshes.h"

namespace rtrays::test {

/// How a ray passes one triangle, in double precision.
struct DoubleHit {
    bool crosses = false;  ///< the line meets the triangle
    double t = 0;          ///< where, in lengths of the direction; not finite for a parallel triangle
    double clearance = 0;  ///< least distance between the line and the lines of the three edges
    double cosine = 0;     ///< between the line and the normal, not negative
};

inline DoubleHit intersect_double(const Mesh &mesh, uint32_t triangle, const Eigen::Vector3d &origin,
                                  const Eigen::Vector3d &direction) {
    const Eigen::Vector3d v[3] = {mesh.vertex(triangle, 0).cast<double>() - origin,
                                  mesh.vertex(triangle, 1).cast<double>() - origin,
                                  mesh.vertex(triangle, 2).cast<double>() - origin};
    DoubleHit hit;
    hit.clearance = INFINITY;
    double edge[3];
    for (int i = 0; i < 3; ++i) {  // Plücker: the moment of each edge line about the ray
        const Eigen::Vector3d &a = v[(i + 1) % 3], &b = v[(i + 2) % 3];
        edge[i] = direction.dot(a.cross(b));
        const double sine = direction.cross(b - a).norm();
        hit.clearance = std::min(hit.clearance, sine > 0 ? std::abs(edge[i]) / sine : 0.0);
    }
    hit.crosses =
        (edge[0] >= 0 && edge[1] >= 0 && edge[2] >= 0) || (edge[0] <= 0 && edge[1] <= 0 && edge[2] <= 0);
    const Eigen::Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
    hit.t = normal.dot(v[0]) / normal.dot(direction);
    hit.cosine = std::abs(normal.dot(direction)) / (normal.norm() * direction.norm());
    return hit;
}

/// Distance from a point to a triangle.
inline double distance_to_triangle(const Mesh &mesh, uint32_t triangle, const Eigen::Vector3d &p) {
    const Eigen::Vector3d v[3] = {mesh.vertex(triangle, 0).cast<double>(),
                                  mesh.vertex(triangle, 1).cast<double>(),
                                  mesh.vertex(triangle, 2).cast<double>()};
    const Eigen::Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
    bool inside = true;
    double nearest = INFINITY;
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d edge = v[(i + 1) % 3] - v[i];
        inside = inside && normal.cross(edge).dot(p - v[i]) >= 0;
        const double s = std::clamp(edge.dot(p - v[i]) / edge.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - v[i] - s * edge).norm());
    }
    return inside ? std::abs(normal.dot(p - v[0])) / normal.norm() : nearest;
}

/// Whether a float hit (t, triangle; NO_HIT for none) is right within the tolerance, a length: its point lies
/// on its triangle, and no triangle is crossed clearly (farther than a tenth of the tolerance from its edges)
/// and clearly nearer. Where a ray meets a plane at a grazing angle, a shift of the vertices by their
/// rounding in the ray's frame moves the crossing by that over the cosine; a tenth of the tolerance stands
/// for the shift.
inline bool hit_is_right(const Mesh &mesh, const Eigen::Vector3f &origin, const Eigen::Vector3f &direction,
                         float t, uint32_t triangle, double tolerance) {
    const Eigen::Vector3d o = origin.cast<double>(), d = direction.cast<double>();
    const auto slack = [&](const DoubleHit &hit) {
        return (tolerance + 0.1 * tolerance / hit.cosine) / d.norm();
    };
    double limit = INFINITY;
    if (triangle != NO_HIT) {
        if (!(distance_to_triangle(mesh, triangle, o + static_cast<double>(t) * d) <= tolerance)) {
            return false;
        }
        limit = static_cast<double>(t) - slack(intersect_double(mesh, triangle, o, d));
    }
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const DoubleHit hit = intersect_double(mesh, i, o, d);
        if (hit.crosses && hit.clearance > 0.1 * tolerance && hit.t > slack(hit) &&
            hit.t + slack(hit) < limit) {
            return false;
        }
    }
    return true;
}

}  // namespace rtrays::test
