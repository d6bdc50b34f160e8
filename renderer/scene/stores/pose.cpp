// SPDX-License-Identifier: MIT
#include "renderer/scene/stores/pose.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "renderer/base/error.h"

namespace rtrays {

double similarity_scale(const Eigen::Matrix4d &transform) {
    // Far above the rounding of a chain of transforms, far below what is visible in an image.
    constexpr double tolerance = 1e-6;
    const Eigen::Matrix3d axes = transform.topLeftCorner<3, 3>();
    const double scale = axes.col(0).stableNorm();
    const Eigen::Matrix3d unit = axes / scale;
    const Eigen::Matrix3d error = unit.transpose() * unit - Eigen::Matrix3d::Identity();
    return error.cwiseAbs().maxCoeff() < tolerance ? scale : 0;
}

Pose pose_of(const Eigen::Matrix4d &transform, const std::string &what) {
    const double scale = similarity_scale(transform);
    if (scale == 0) {
        throw input_error(fmt::format(
            "{}: its transform shears or scales the axes differently; use a uniform scale", what));
    }
    const Eigen::Matrix3d unit = transform.topLeftCorner<3, 3>() / scale;
    if (unit.determinant() < 0) {
        throw input_error(fmt::format("{}: its transform mirrors, which is not supported", what));
    }
    Pose pose{transform, scale};
    pose.rigid.topLeftCorner<3, 3>() = Eigen::Quaterniond(unit).normalized().toRotationMatrix();
    return pose;
}

Eigen::Matrix4d frame_along_z(const Eigen::Matrix4d &transform) {
    const Eigen::Vector3d z = transform.col(2).head<3>().stableNormalized();
    // Any orthogonal axis is valid; the unit axis of z's smallest coordinate is far from parallel
    // to z.
    Eigen::Index smallest = 0;
    z.cwiseAbs().minCoeff(&smallest);
    const Eigen::Vector3d x = Eigen::Vector3d::Unit(smallest).cross(z).normalized();
    Eigen::Matrix4d frame = transform;
    frame.col(0).head<3>() = x;
    frame.col(1).head<3>() = z.cross(x);
    frame.col(2).head<3>() = z;
    return frame;
}

}  // namespace rtrays
