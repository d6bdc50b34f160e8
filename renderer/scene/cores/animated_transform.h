// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "renderer/scene/cores/transform.h"

namespace rtrays {

/// Where a node is at one time.
struct Keyframe {
    double time;  ///< scene time, seconds
    Eigen::Matrix4d parent_from_object;
};

/// A transform that follows keyframes. Between two of them the matrix is split into rotation and
/// stretch by its polar decomposition (Shoemake and Duff, "Matrix animation and polar
/// decomposition", Graphics Interface 1992): translation and stretch are interpolated linearly, the
/// rotation along the shortest arc (slerp). At a keyframe the matrix is that of the keyframe to the
/// bit; before the first and after the last it stays as it is there.
class AnimatedTransform : public TransformCore {
  public:
    /// Throws `Error` (bad input) naming the keyframe when there is none, times are not finite and
    /// ascending, a matrix is one that `TransformCore` refuses, or the way between two keyframes is
    /// not defined: one mirrors and the other does not, or they differ by half a turn.
    AnimatedTransform(std::string name, const std::vector<Keyframe> &keyframes);

    bool is_animated() const override { return true; }
    void update(double time) override;

    /// To be read; the keyframes decide.
    std::vector<Property> properties() override;

    Eigen::Matrix4d matrix_at(double time) const;

  private:
    struct Key {
        double time;
        Eigen::Matrix4d matrix;
        Eigen::Quaterniond rotation;
        Eigen::Matrix3d stretch;  ///< symmetric, and negative definite where the matrix mirrors
    };

    std::vector<Key> keys_;
};

}  // namespace rtrays
