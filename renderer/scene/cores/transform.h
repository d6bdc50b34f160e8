// SPDX-License-Identifier: MIT
// Transform cores, and functions that make transforms.
#pragma once

#include <Eigen/Core>

#include "renderer/scene/core.h"

namespace rtrays {

/// Object-to-world transform in double precision. The transform of a child is applied first, then
/// that of its parent.
struct TransformAttribute : AttributeOf<TransformAttribute> {
    Eigen::Matrix4d world_from_object = Eigen::Matrix4d::Identity();

    void combine(const TransformAttribute &own) { world_from_object *= own.world_from_object; }
};

/// An affine transform of a node and everything below it.
class TransformCore : public Core {
  public:
    /// Throws `Error` (bad input) if the matrix is not finite, not affine or not invertible.
    TransformCore(std::string name, const Eigen::Matrix4d &parent_from_object);

    CoreRole role() const override { return CoreRole::transform; }
    const char *type_name() const override { return "transform"; }
    std::vector<Property> properties() override;
    const NodeAttribute *attribute() const override { return &attribute_; }

    const Eigen::Matrix4d &matrix() const { return attribute_.world_from_object; }
    void set_matrix(const Eigen::Matrix4d &parent_from_object);
    void set_translation(const Eigen::Vector3d &translation);

  private:
    TransformAttribute attribute_;
};

Eigen::Matrix4d translation(const Eigen::Vector3d &offset);
Eigen::Matrix4d scaling(const Eigen::Vector3d &factors);

/// Returns the rotation about `axis` (any length but zero), counter-clockwise if the axis points at
/// the viewer.
Eigen::Matrix4d rotation(const Eigen::Vector3d &axis, double radians);

/// Returns the rigid pose at `origin` whose -z axis points at `target` and whose +y axis is as
/// close to `up` as possible. Throws `Error` (bad input) if the arguments do not define a pose.
Eigen::Matrix4d look_at(const Eigen::Vector3d &origin, const Eigen::Vector3d &target,
                        const Eigen::Vector3d &up);

}  // namespace rtrays
