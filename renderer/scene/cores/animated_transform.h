// SPDX-License-Identifier: MIT
// Transforms animated by keyframes.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "renderer/scene/cores/transform.h"

namespace rtrays {

/// The transform of a node at one time.
struct Keyframe {
    double time;  ///< scene time, seconds
    Eigen::Matrix4d parent_from_object;
};

/// A transform that follows keyframes. Between two keyframes the polar decomposition splits the
/// matrix into rotation and stretch (Shoemake and Duff, "Matrix animation and polar decomposition",
/// Graphics Interface 1992). Translation and stretch are interpolated linearly, the rotation along
/// the shortest arc (slerp). At a keyframe the matrix is bitwise equal to that of the keyframe.
/// Before the first and after the last keyframe it is constant.
class AnimatedTransform : public TransformCore {
  public:
    /// Throws `Error` (bad input), naming the keyframe where one is at fault, if there are no
    /// keyframes, times are not finite and ascending, or `TransformCore` rejects a matrix. Also
    /// throws if the interpolation between two keyframes is undefined: one mirrors and the other
    /// does not, or they differ by half a turn.
    AnimatedTransform(std::string name, const std::vector<Keyframe> &keyframes);

    bool is_animated() const override { return true; }
    void update(double time) override;

    /// Returns read-only properties, because the keyframes determine the values.
    std::vector<Property> properties() override;

    /// Returns the interpolated matrix at a scene time in seconds.
    Eigen::Matrix4d matrix_at(double time) const;

  private:
    struct Key {
        double time;
        Eigen::Matrix4d matrix;
        Eigen::Quaterniond rotation;
        Eigen::Matrix3d stretch;  ///< symmetric; negative definite if the matrix mirrors
    };

    std::vector<Key> keys_;
};

}  // namespace rtrays
