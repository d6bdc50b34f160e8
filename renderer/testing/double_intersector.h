// SPDX-License-Identifier: MIT
// Brute-force ray-triangle intersection in double precision, which judges the hits of traversal.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "renderer/kernels/traversal/intersect_triangle.h"
#include "renderer/testing/bvh_meshes.h"

namespace rtrays::test {

/// Intersection of a ray with one triangle, in double precision.
struct DoubleHit {
    bool crosses = false;  ///< whether the line crosses the triangle
    /// Distance along the line, in lengths of the direction; not finite for a parallel triangle.
    double t = 0;
    double clearance = 0;  ///< least distance between the line and the lines of the three edges
    double cosine = 0;     ///< absolute cosine between the line and the normal
    /// Length by which rounding in the float test may move a vertex perpendicular to the ray.
    double shift = 0;
};

inline DoubleHit intersect_double(const Mesh &mesh, uint32_t triangle,
                                  const Eigen::Vector3d &origin, const Eigen::Vector3d &direction) {
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
    hit.crosses = (edge[0] >= 0 && edge[1] >= 0 && edge[2] >= 0) ||
                  (edge[0] <= 0 && edge[1] <= 0 && edge[2] <= 0);
    const Eigen::Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
    hit.t = normal.dot(v[0]) / normal.dot(direction);
    hit.cosine = std::abs(normal.dot(direction)) / (normal.norm() * direction.norm());
    // The bound is 6 u E along each of two axes (kernels/traversal/traversal_ray.h), u = 2^-24.
    for (const Eigen::Vector3d &vertex : v) {
        hit.shift =
            std::max(hit.shift, std::sqrt(2.0) * 6 * 0x1p-24 * vertex.cwiseAbs().maxCoeff());
    }
    return hit;
}

/// Returns the distance from a point to a triangle.
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

/// Returns whether a float hit (t, triangle; NO_HIT for a miss) is right within the tolerance, a
/// length. The hit point must be on the triangle, and no other triangle may be crossed clearly and
/// clearly nearer.
///
/// The float test is exact except for two roundings: of the vertices in the ray's frame and of t,
/// relative to the distance. Its decision is therefore right for a triangle whose vertices are
/// moved perpendicular to the ray by at most `shift`. The ray certainly crosses that triangle if it
/// stays farther than `shift` from the edges. It meets that triangle's plane within shift / cosine
/// of the crossing with the given plane. A float test has no bound without the cosine: at 1e-5 from
/// the plane (ray_sets.h), a change of a vertex by one ulp moves the crossing by 1e5 ulps.
///
/// `for_each(visit)` calls visit(i) for all triangles that the ray's line may cross.
template <typename ForEach>
bool hit_is_right(const Mesh &mesh, const Eigen::Vector3f &origin, const Eigen::Vector3f &direction,
                  float t, uint32_t triangle, double tolerance, const ForEach &for_each) {
    const Eigen::Vector3d o = origin.cast<double>(), d = direction.cast<double>();
    const auto slack = [&](const DoubleHit &hit) {
        return (tolerance + hit.shift / hit.cosine) / d.norm();
    };
    double limit = INFINITY;
    if (triangle != NO_HIT) {
        if (!(distance_to_triangle(mesh, triangle, o + static_cast<double>(t) * d) <= tolerance)) {
            return false;
        }
        limit = static_cast<double>(t) - slack(intersect_double(mesh, triangle, o, d));
    }
    bool nearest = true;
    for_each([&](uint32_t i) {
        const DoubleHit hit = intersect_double(mesh, i, o, d);
        nearest = nearest && !(hit.crosses && hit.clearance > hit.shift && hit.t > slack(hit) &&
                               hit.t + slack(hit) < limit);
    });
    return nearest;
}

inline bool hit_is_right(const Mesh &mesh, const Eigen::Vector3f &origin,
                         const Eigen::Vector3f &direction, float t, uint32_t triangle,
                         double tolerance) {
    return hit_is_right(mesh, origin, direction, t, triangle, tolerance, [&](const auto &visit) {
        for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            visit(i);
        }
    });
}

/// Applies `hit_is_right` to many rays through a large mesh. A tree of boxes in double precision
/// excludes triangles that a line misses. It is split in halves by count, and a box is excluded
/// only if its separation from the line exceeds rounding errors.
class DoubleJudge {
  public:
    explicit DoubleJudge(const Mesh &mesh) : mesh_(&mesh), order_(mesh.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        add_node(0, order_.size());
    }

    bool is_right(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float t,
                  uint32_t triangle, double tolerance) const {
        const Eigen::Vector3d o = origin.cast<double>(), d = direction.cast<double>();
        return hit_is_right(
            *mesh_, origin, direction, t, triangle, tolerance, [&](const auto &visit) {
                std::vector<size_t> pending = {0};
                while (!pending.empty()) {
                    const Node &node = nodes_[pending.back()];
                    pending.pop_back();
                    if (!may_cross(node.box, o, d)) {
                        continue;
                    }
                    if (node.second != 0) {
                        pending.push_back(node.first);
                        pending.push_back(node.second);
                    }
                    for (size_t i = node.begin; node.second == 0 && i < node.end; ++i) {
                        visit(order_[i]);
                    }
                }
            });
    }

  private:
    struct Node {
        Eigen::AlignedBox3d box;
        size_t begin, end;
        size_t first, second;  ///< children; 0 in a leaf
    };
    static constexpr size_t leaf_size = 8;

    /// Tests the separating axes of a line and a box, which are the cross products of the line's
    /// direction and the box's axes.
    static bool may_cross(const Eigen::AlignedBox3d &box, const Eigen::Vector3d &o,
                          const Eigen::Vector3d &d) {
        const Eigen::Vector3d to_centre = box.center() - o;
        const Eigen::Vector3d half =
            (0.5 * box.sizes()).array() + 1e-9 * (box.sizes().norm() + to_centre.norm());
        const Eigen::Vector3d apart = d.cross(to_centre).cwiseAbs(), a = d.cwiseAbs();
        return apart.x() <= half.y() * a.z() + half.z() * a.y() &&
               apart.y() <= half.x() * a.z() + half.z() * a.x() &&
               apart.z() <= half.x() * a.y() + half.y() * a.x();
    }

    Eigen::Vector3d vertex(uint32_t triangle, uint32_t corner) const {
        return mesh_->vertex(triangle, corner).cast<double>();
    }

    size_t add_node(size_t begin, size_t end) {
        const size_t index = nodes_.size();
        nodes_.push_back({{}, begin, end, 0, 0});
        Eigen::AlignedBox3d box;
        for (size_t i = begin; i < end; ++i) {
            for (uint32_t corner = 0; corner < 3; ++corner) {
                box.extend(vertex(order_[i], corner));
            }
        }
        nodes_[index].box = box;
        if (end - begin > leaf_size) {
            int axis = 0;
            box.sizes().maxCoeff(&axis);
            const size_t middle = (begin + end) / 2;
            const auto at = [&](size_t i) {
                return order_.begin() + static_cast<std::ptrdiff_t>(i);
            };
            std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
                return mesh_->vertex(a, 0)[axis] < mesh_->vertex(b, 0)[axis];
            });
            nodes_[index].first = add_node(begin, middle);
            nodes_[index].second = add_node(middle, end);
        }
        return index;
    }

    const Mesh *mesh_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace rtrays::test
