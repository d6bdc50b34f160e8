// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "renderer/scene/cores/parameter_core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

struct ShapeType : CoreType {
    ShapeArrays::Kind kind;
    /// Factors from the canonical surface of stores.h to the one with these parameters.
    Eigen::Vector3d (*scale)(const ParameterSet &);
};

/// All types; an ellipsoid is a sphere scaled, so two may have one kind.
const std::vector<ShapeType> &shape_types();

/// Geometry that is not made of triangles.
class ShapeCore : public ParameterCore {
  public:
    /// Throws `Error` (bad input) as `ParameterCore`, and listing the types when `type` is none of
    /// them.
    ShapeCore(std::string name, const std::string &type, const ParameterValues &values);

    CoreRole role() const override { return CoreRole::geometry; }

    ShapeArrays::Kind kind() const;

    /// From the canonical surface to that of the node.
    Eigen::Matrix4d object_from_canonical() const;

    /// Box around the canonical surface; empty for the unbounded plane.
    Eigen::AlignedBox3d canonical_bounds() const;
};

}  // namespace rtrays
