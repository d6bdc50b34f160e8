// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "reference/camera.h"
#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A triangle of non-zero area, world space.
struct TriangleRecord {
    Vec3 vertex;    ///< the first one
    Vec3 edge1;     ///< to the second vertex
    Vec3 edge2;     ///< to the third vertex
    Vec3 normal;    ///< unit, towards the side from which the vertices run counter-clockwise
    double offset;  ///< distance from the plane at which float rays start
    double margin;  ///< barycentric distance from the edges kept by ray origins
    uint32_t material;
    uint32_t light;  ///< `no_index` when it does not emit
    bool has_normals;
    bool has_uv;

    /// Second and third barycentric coordinate in, world position out.
    Vec3 point(const Eigen::Vector2d &barycentric) const {
        return vertex + barycentric.x() * edge1 + barycentric.y() * edge2;
    }
    double area() const { return 0.5 * edge1.cross(edge2).norm(); }

    /// Barycentrics of the point where the ray's line meets the plane (Moeller & Trumbore 1997),
    /// moved onto the triangle: a float hit next to an edge, or at a grazing angle, may lie outside
    /// in double. `fallback` is used when the line is parallel to the plane.
    Eigen::Vector2d intersect_plane(const Ray &ray, const Eigen::Vector2d &fallback) const;

    /// Where a ray that leaves `position`, whose barycentrics are the first two of `local`, to the
    /// side of `direction` starts: off the plane by a multiple of what float rounding and Embree's
    /// float arithmetic can do, so that it never meets its own triangle, and away from the edges by
    /// four times as much, so that it is not pushed through a neighbour that meets this triangle at
    /// an edge with more than 14 degrees.
    Vec3 spawn_point(const Vec3 &position, const Vec3 &local, const Vec3 &direction) const;
};

/// Fills the record of triangle `index` of the store; returns false when its area is zero (or below
/// what double can tell from zero). Throws `Error` (bad input) for a vertex that is not finite.
bool make_record(const MeshArrays &meshes, uint32_t index, TriangleRecord &record);

inline Eigen::Vector2d TriangleRecord::intersect_plane(const Ray &ray,
                                                       const Eigen::Vector2d &fallback) const {
    const Vec3 p = ray.direction.cross(edge2);
    const double determinant = edge1.dot(p);
    const Vec3 to_origin = ray.origin - vertex;
    const Vec3 q = to_origin.cross(edge1);
    double u = to_origin.dot(p) / determinant;
    double v = ray.direction.dot(q) / determinant;
    if (!std::isfinite(u) || !std::isfinite(v)) {
        u = fallback.x();
        v = fallback.y();
    }
    u = std::min(std::max(u, 0.0), 1.0);
    return {u, std::min(std::max(v, 0.0), 1.0 - u)};
}

inline Vec3 TriangleRecord::spawn_point(const Vec3 &position, const Vec3 &local,
                                        const Vec3 &direction) const {
    const double side = std::copysign(offset, normal.dot(direction));
    const double smallest = std::min({local.x(), local.y(), 1.0 - (local.x() + local.y())});
    if (smallest >= margin) {
        return position + side * normal;
    }
    // Towards the centroid until the nearest edge is `margin` away.
    const double share = (margin - smallest) / (1.0 / 3.0 - smallest);
    const Eigen::Vector2d barycentric = local.head<2>();
    const Eigen::Vector2d inner =
        barycentric + share * (Eigen::Vector2d::Constant(1.0 / 3.0) - barycentric);
    return point(inner) + side * normal;
}

}  // namespace rtrays::reference
