// SPDX-License-Identifier: MIT
// Triangles in double precision: hit points, and origins of rays that leave them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "reference/camera.h"
#include "reference/math.h"
#include "renderer/scene/stores.h"

namespace rtrays::reference {

/// A triangle of non-zero area in world space.
struct TriangleRecord {
    Vec3 vertex;    ///< first vertex
    Vec3 edge1;     ///< from the first to the second vertex
    Vec3 edge2;     ///< from the first to the third vertex
    Vec3 normal;    ///< unit, towards the side from which the vertices run counter-clockwise
    double offset;  ///< distance from the plane at which float rays start
    double margin;  ///< barycentric distance that ray origins keep from the edges
    uint32_t material;
    uint32_t light;  ///< `no_index` if the triangle does not emit
    bool has_normals;
    bool has_uv;
    bool has_colour;

    /// Returns the world position of the barycentrics of the second and third vertex.
    Vec3 point(const Eigen::Vector2d &barycentric) const {
        return vertex + barycentric.x() * edge1 + barycentric.y() * edge2;
    }
    double area() const { return 0.5 * edge1.cross(edge2).norm(); }

    /// Returns the barycentrics of the point where the line of the ray meets the plane (Moeller &
    /// Trumbore 1997), moved onto the triangle. A float hit next to an edge or at a grazing angle
    /// may be outside the triangle in double. `fallback` is used if the line is parallel to the
    /// plane.
    Eigen::Vector2d intersect_plane(const Ray &ray, const Eigen::Vector2d &fallback) const;

    /// Returns the origin of a ray that leaves `position` to the side of `direction`. The first two
    /// components of `local` are the barycentrics of `position`.
    ///
    /// The origin is off the plane by a multiple of the error of float rounding and Embree's float
    /// arithmetic, so that the ray never meets its own triangle. It is away from the edges by four
    /// times as much. Therefore it is not pushed through a neighbour that meets this triangle at an
    /// edge with an angle above 14 degrees.
    Vec3 spawn_point(const Vec3 &position, const Vec3 &local, const Vec3 &direction) const;
};

/// Fills the record of triangle `index` of the store. Returns false if its area is zero, or too
/// small to be distinguished from zero in double. Throws `Error` (bad input) for a vertex that is
/// not finite.
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
    // Moves the point towards the centroid until the nearest edge is `margin` away.
    const double share = (margin - smallest) / (1.0 / 3.0 - smallest);
    const Eigen::Vector2d barycentric = local.head<2>();
    const Eigen::Vector2d inner =
        barycentric + share * (Eigen::Vector2d::Constant(1.0 / 3.0) - barycentric);
    return point(inner) + side * normal;
}

}  // namespace rtrays::reference
