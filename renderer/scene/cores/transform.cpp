// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/transform.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Returns the determinant of the linear part with normalised columns: 1 for orthogonal axes of any
/// scale (-1 if it mirrors), 0 for axes in a plane.
double normalised_determinant(const Eigen::Matrix4d &matrix) {
    Eigen::Matrix3d axes = matrix.topLeftCorner<3, 3>();
    for (int i = 0; i < 3; ++i) {
        const double length = axes.col(i).stableNorm();
        if (length == 0) {
            return 0;
        }
        axes.col(i) /= length;
    }
    return axes.determinant();
}

}  // namespace

TransformCore::TransformCore(std::string name, const Eigen::Matrix4d &parent_from_object)
    : Core(std::move(name)) {
    set_matrix(parent_from_object);
}

void TransformCore::set_matrix(const Eigen::Matrix4d &parent_from_object) {
    // Below this value, double precision cannot distinguish the axes from coplanar ones.
    constexpr double flat = 1e-12;
    if (!parent_from_object.allFinite()) {
        throw input_error("transform: the matrix is not finite");
    }
    if (parent_from_object.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
        throw input_error("transform: the matrix is not affine; its last row must be 0, 0, 0, 1");
    }
    if (std::abs(normalised_determinant(parent_from_object)) < flat) {
        throw input_error("transform: the matrix is not invertible");
    }
    attribute_.world_from_object = parent_from_object;
    changed(Dirty::subtree);
}

void TransformCore::set_translation(const Eigen::Vector3d &offset) {
    Eigen::Matrix4d moved = matrix();
    moved.topRightCorner<3, 1>() = offset;
    set_matrix(moved);
}

std::vector<Property> TransformCore::properties() {
    return {make_property<Eigen::Matrix4d>(
                "transform", "parent-from-object matrix, row by row", [this] { return matrix(); },
                [this](const Eigen::Matrix4d &value) { set_matrix(value); }),
            make_property<Eigen::Vector3d>(
                "translation", "last column of the transform",
                [this] { return matrix().topRightCorner<3, 1>(); },
                [this](const Eigen::Vector3d &value) { set_translation(value); })};
}

Eigen::Matrix4d translation(const Eigen::Vector3d &offset) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topRightCorner<3, 1>() = offset;
    return matrix;
}

Eigen::Matrix4d scaling(const Eigen::Vector3d &factors) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.diagonal().head<3>() = factors;
    return matrix;
}

Eigen::Matrix4d rotation(const Eigen::Vector3d &axis, double radians) {
    const double length = axis.stableNorm();
    if (!(length > 0) || !std::isfinite(length)) {
        throw input_error("rotate: the axis has no direction");
    }
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = Eigen::AngleAxisd(radians, axis / length).toRotationMatrix();
    return matrix;
}

Eigen::Matrix4d look_at(const Eigen::Vector3d &origin, const Eigen::Vector3d &target,
                        const Eigen::Vector3d &up) {
    // Below this sine `up` is parallel to the view direction within double precision.
    constexpr double parallel = 1e-9;
    const Eigen::Vector3d back = origin - target;
    const double distance = back.stableNorm();
    const double up_length = up.stableNorm();
    if (!(distance > 0) || !std::isfinite(distance)) {
        throw input_error("look_at: origin and target must be different points");
    }
    if (!(up_length > 0) || !std::isfinite(up_length)) {
        throw input_error("look_at: up has no direction");
    }
    const Eigen::Vector3d z = back / distance;
    const Eigen::Vector3d across = (up / up_length).cross(z);
    if (across.norm() < parallel) {
        throw input_error("look_at: up must not be parallel to the view direction");
    }
    const Eigen::Vector3d x = across.normalized();
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.col(0).head<3>() = x;
    matrix.col(1).head<3>() = z.cross(x);
    matrix.col(2).head<3>() = z;
    matrix.col(3).head<3>() = origin;
    return matrix;
}

}  // namespace rtrays
