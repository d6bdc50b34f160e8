// SPDX-License-Identifier: MIT
#include "renderer/compile/emitter_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace rtrays {

namespace {

Eigen::Vector3d vector_of(const float (&v)[3]) {
    return Eigen::Vector3f(v).cast<double>();
}

/// The pyramid of the directions that a film sees.
class View {
  public:
    explicit View(const CameraRecord &camera) : apex_(vector_of(camera.position)) {
        const Eigen::Vector3d corner = vector_of(camera.corner);
        const Eigen::Vector3d across =
            vector_of(camera.step_x) * static_cast<double>(camera.full_width);
        const Eigen::Vector3d down =
            vector_of(camera.step_y) * static_cast<double>(camera.full_height);
        const std::array<Eigen::Vector3d, 4> edges = {corner, corner + across,
                                                      corner + across + down, corner + down};
        const Eigen::Vector3d axis = corner + (across + down) / 2;
        for (size_t i = 0; i < sides_.size(); ++i) {
            sides_[i] = edges[i].cross(edges[(i + 1) % sides_.size()]).normalized();
            sides_[i] *= sides_[i].dot(axis) < 0 ? -1 : 1;
        }
    }

    /// Returns whether one side has all of `points`, each with a ball of `radius`, outside. The
    /// margin exceeds the rounding of float positions and of the film's edge.
    template <typename Points>
    bool excludes(const Points &points, double radius) const {
        return std::any_of(sides_.begin(), sides_.end(), [&](const Eigen::Vector3d &side) {
            return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d &point) {
                const Eigen::Vector3d from_apex = point - apex_;
                const double margin = 1e-5 * (from_apex.norm() + point.norm());
                return side.dot(from_apex) < -(radius + margin);
            });
        });
    }

  private:
    Eigen::Vector3d apex_;
    std::array<Eigen::Vector3d, 4> sides_;  ///< unit normals, inwards
};

}  // namespace

bool emitters_in_view(const CompiledScene &compiled, const CameraRecord &camera) {
    if (camera.aperture_radius > 0 || camera.orthographic != 0) {
        return true;
    }
    const View view(camera);
    for (const EmitterTriangle &emitter : compiled.emitter_triangles) {
        const SurfaceTriangle &triangle = compiled.surface_triangles[emitter.triangle];
        const std::array<Eigen::Vector3d, 3> corners = {
            vector_of(triangle.p0), vector_of(triangle.p1), vector_of(triangle.p2)};
        if (!view.excludes(corners, 0)) {
            return true;
        }
    }
    for (const ShapeRecord &shape : compiled.shapes) {
        if (shape.light == NO_EMITTER) {
            continue;
        }
        const SceneExtent extent = extent_of_shape(shape);
        if (!view.excludes(std::array<Eigen::Vector3d, 1>{extent.centre}, extent.radius)) {
            return true;
        }
    }
    return false;
}

}  // namespace rtrays
