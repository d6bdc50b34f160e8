// SPDX-License-Identifier: MIT
// Shape cores: geometry that is not made of triangles.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

struct ShapeType : CoreType {
    ShapeArrays::Kind kind;
    /// Returns the factors from the canonical surface of stores.h to that of these parameters.
    Eigen::Vector3d (*scale)(const ParameterSet &);
};

/// Returns all types. Two types may have the same kind: an ellipsoid is a scaled sphere.
const std::vector<ShapeType> &shape_types();

/// Geometry that is not made of triangles.
class ShapeCore : public ParameterCore {
  public:
    /// Throws `Error` (bad input) like `ParameterCore`, and for an unknown type, listing the types.
    ShapeCore(std::string name, const std::string &type, const ParameterValues &values);

    CoreRole role() const override { return CoreRole::geometry; }

    ShapeArrays::Kind kind() const;

    /// Returns the transform from the canonical surface to that of the node.
    Eigen::Matrix4d object_from_canonical() const;

    /// Returns the bounding box of the canonical surface, empty for the unbounded plane.
    Eigen::AlignedBox3d canonical_bounds() const;
};

}  // namespace rtrays
