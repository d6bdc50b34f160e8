// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/scene/core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

/// Triangles in object space, double precision. The front of a triangle is where its vertices
/// appear counter-clockwise. Shared by several nodes it is instanced: each has its own,
/// transformed, records.
class MeshCore : public Core {
  public:
    struct Geometry {
        std::vector<Eigen::Vector3d> vertices;
        std::vector<Triangle> triangles;
        std::vector<Eigen::Vector3d> normals{};  ///< per vertex, any length but zero; or empty
        std::vector<Eigen::Vector2d> uvs{};      ///< per vertex; or empty
    };

    /// Throws `Error` (bad input) naming the mesh and the vertex or triangle when there is no
    /// triangle, a coordinate is not finite, a normal has no direction, a texture coordinate is
    /// beyond a million or an index or a length does not fit. Zero-area triangles are legal.
    MeshCore(std::string name, Geometry geometry);
    MeshCore(std::string name, std::vector<Eigen::Vector3d> vertices,
             std::vector<Triangle> triangles);

    CoreRole role() const override { return CoreRole::geometry; }
    const char *type_name() const override { return "mesh"; }
    std::vector<Property> properties() override;

    const std::vector<Eigen::Vector3d> &vertices() const { return geometry_.vertices; }
    const std::vector<Triangle> &triangles() const { return geometry_.triangles; }
    const std::vector<Eigen::Vector3d> &normals() const { return geometry_.normals; }  ///< unit
    const std::vector<Eigen::Vector2d> &uvs() const { return geometry_.uvs; }
    void set_geometry(Geometry geometry);

  protected:
    /// Moves the vertices: as many as there are, finite, with as many unit normals as there are.
    void set_vertices(std::vector<Eigen::Vector3d> vertices, std::vector<Eigen::Vector3d> normals);

  private:
    Geometry geometry_;
};

/// The square z = 0, -1 <= x, y <= 1, facing +z, (u, v) from (0, 0) to (1, 1).
MeshCore::Geometry rectangle();

/// The cube -1 <= x, y, z <= 1, facing outwards; (u, v) from (0, 0) to (1, 1) on every side.
MeshCore::Geometry box();

}  // namespace rtrays
