// SPDX-License-Identifier: MIT
// Ear clipping (Meisters, "Polygons have ears", American Mathematical Monthly 82(6), 1975).
#include "renderer/import/models/triangulate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

using Vector2d = Eigen::Vector2d;

/// Returns twice the signed area of a triangle, positive if it is counter-clockwise.
double turn(const Vector2d &a, const Vector2d &b, const Vector2d &c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Returns the corners projected to a coordinate plane, scaled to the size of the polygon and
/// counter-clockwise. Returns nothing for a polygon of zero area.
std::vector<Vector2d> project(const std::vector<Eigen::Vector3d> &vertices,
                              const std::vector<uint32_t> &corners) {
    const size_t n = corners.size();
    const Eigen::Vector3d &origin = vertices[corners[0]];
    double size = 0;
    for (const uint32_t corner : corners) {
        size = std::max(size, (vertices[corner] - origin).cwiseAbs().maxCoeff());
    }
    if (size == 0) {
        return {};
    }
    // Newell's normal is the vector area, which is defined for any polygon.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    const auto scaled = [&](size_t i) -> Eigen::Vector3d {
        return (vertices[corners[i % n]] - origin) / size;
    };
    for (size_t i = 0; i < n; ++i) {
        normal += scaled(i).cross(scaled(i + 1));
    }
    if (normal.norm() == 0) {
        return {};
    }
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    std::vector<Vector2d> points;
    for (size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d p = scaled(i);
        points.emplace_back(normal[axis] > 0 ? p[u] : -p[u], p[v]);
    }
    return points;
}

bool is_convex(const std::vector<Vector2d> &points) {
    const size_t n = points.size();
    for (size_t i = 0; i < n; ++i) {
        if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0) {
            return false;
        }
    }
    // Left turns at all corners are not sufficient, as a pentagram shows. Every triangle of the fan
    // must turn left, too.
    for (size_t i = 1; i + 1 < n; ++i) {
        if (turn(points[0], points[i], points[i + 1]) < 0) {
            return false;
        }
    }
    return true;
}

/// Returns whether corner `at` of the remaining corners `left` can be cut off. Such a corner does
/// not turn right, and no other corner is in its triangle.
bool is_ear(const std::vector<Vector2d> &points, const std::vector<uint32_t> &left, size_t at) {
    const size_t n = left.size();
    const Vector2d &a = points[left[(at + n - 1) % n]];
    const Vector2d &b = points[left[at]];
    const Vector2d &c = points[left[(at + 1) % n]];
    if (turn(a, b, c) < 0) {
        return false;
    }
    for (size_t i = 0; i < n; ++i) {
        const Vector2d &p = points[left[i]];
        const bool is_corner = p == a || p == b || p == c;
        if (!is_corner && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::vector<Triangle> triangulate(const std::vector<Eigen::Vector3d> &vertices,
                                  const std::vector<uint32_t> &corners) {
    if (corners.size() < 3) {
        throw input_error(fmt::format("has {} corners; expected at least 3", corners.size()));
    }
    for (const uint32_t corner : corners) {
        if (corner >= vertices.size()) {
            throw input_error(fmt::format("has vertex index {}, but there are only {} vertices",
                                          corner, vertices.size()));
        }
    }
    const std::vector<Vector2d> points =
        corners.size() > 3 ? project(vertices, corners) : std::vector<Vector2d>{};
    std::vector<Triangle> triangles;
    if (points.empty() || is_convex(points)) {
        for (size_t i = 1; i + 1 < corners.size(); ++i) {
            triangles.push_back({corners[0], corners[i], corners[i + 1]});
        }
        return triangles;
    }
    std::vector<uint32_t> left(corners.size());
    for (uint32_t i = 0; i < left.size(); ++i) {
        left[i] = i;
    }
    while (left.size() >= 3) {
        size_t ear = 0;
        while (ear < left.size() && !is_ear(points, left, ear)) {
            ++ear;
        }
        if (ear == left.size()) {
            throw input_error("crosses itself; split it into simple polygons");
        }
        const size_t n = left.size();
        triangles.push_back(
            {corners[left[(ear + n - 1) % n]], corners[left[ear]], corners[left[(ear + 1) % n]]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return triangles;
}

}  // namespace rtrays
