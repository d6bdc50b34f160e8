// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

namespace rtrays {

/// A transform that is a rotation, a uniform scale and a translation.
struct Pose {
    Eigen::Matrix4d rigid;
    double scale;
};

/// The pose that the transform is; throws `Error` (bad input) naming `what` when it mirrors, shears
/// or scales axes differently.
Pose pose_of(const Eigen::Matrix4d &transform, const std::string &what);

/// Scale of a transform that is a rotation, maybe a mirror, and a uniform scale; 0 when it is not.
double similarity_scale(const Eigen::Matrix4d &transform);

/// A rigid frame at the transform's origin whose z axis is that of the transform (invertible,
/// otherwise arbitrary).
Eigen::Matrix4d frame_along_z(const Eigen::Matrix4d &transform);

}  // namespace rtrays
