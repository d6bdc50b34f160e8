// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/scene/core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

/// Triangles in object space, double precision. The front of a triangle is where its vertices appear
/// counter-clockwise. Shared by several nodes it is instanced: each has its own, transformed, records.
class MeshCore : public Core {
  public:
    /// Throws `Error` (bad input) naming the mesh and the vertex or triangle when there is no triangle, a
    /// coordinate is not finite or an index is out of range. Zero-area triangles are legal.
    MeshCore(std::string name, std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles);

    CoreRole role() const override { return CoreRole::geometry; }
    const char *type_name() const override { return "mesh"; }
    std::vector<Property> properties() override;

    const std::vector<Eigen::Vector3d> &vertices() const { return vertices_; }
    const std::vector<Triangle> &triangles() const { return triangles_; }
    void set_geometry(std::vector<Eigen::Vector3d> vertices, std::vector<Triangle> triangles);

  private:
    std::vector<Eigen::Vector3d> vertices_;
    std::vector<Triangle> triangles_;
};

}  // namespace rtrays
