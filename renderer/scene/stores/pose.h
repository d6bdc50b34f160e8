// SPDX-License-Identifier: MIT
// Decomposition of transforms to rigid poses.
#pragma once

#include <Eigen/Core>
#include <string>

namespace rtrays {

/// A transform that consists of a rotation, a uniform scale and a translation.
struct Pose {
    Eigen::Matrix4d rigid;
    double scale;
};

/// Returns the pose that equals the transform. Throws `Error` (bad input) naming `what` if the
/// transform mirrors, shears or scales the axes differently.
Pose pose_of(const Eigen::Matrix4d &transform, const std::string &what);

/// Returns the scale of a transform that consists of a rotation, possibly a mirroring, and a
/// uniform scale; 0 for any other transform.
double similarity_scale(const Eigen::Matrix4d &transform);

/// Returns a rigid frame at the origin of the transform, with the same z axis. The transform may be
/// any invertible one.
Eigen::Matrix4d frame_along_z(const Eigen::Matrix4d &transform);

}  // namespace rtrays
