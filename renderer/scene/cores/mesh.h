// SPDX-License-Identifier: MIT
// Triangle mesh cores.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/scene/core.h"
#include "renderer/scene/stores.h"

namespace rtrays {

/// Triangles in object space, in double precision. The front of a triangle is the side from which
/// its vertices appear counter-clockwise. A mesh shared by several nodes is instanced: each node
/// has its own, transformed, records.
class MeshCore : public Core {
  public:
    struct Geometry {
        std::vector<Eigen::Vector3d> vertices;
        std::vector<Triangle> triangles;
        std::vector<Eigen::Vector3d> normals{};  ///< per vertex, any length but zero; may be empty
        std::vector<Eigen::Vector2d> uvs{};      ///< per vertex; may be empty
        std::vector<Eigen::Vector3d> colours{};  ///< per vertex, linear, in [0, 1]; may be empty
    };

    /// Throws `Error` (bad input) naming the mesh and the vertex or triangle if there are no
    /// triangles, a coordinate is not finite, a normal has no direction, a texture coordinate is
    /// beyond a million, a colour is not within [0, 1], or an index or the length of an array is
    /// wrong. Zero-area triangles are legal.
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
    const std::vector<Eigen::Vector3d> &colours() const { return geometry_.colours; }
    const Geometry &geometry() const { return geometry_; }
    void set_geometry(Geometry geometry);

  protected:
    /// Moves the vertices. The numbers of vertices and normals must not change; positions must be
    /// finite and normals unit.
    void set_vertices(std::vector<Eigen::Vector3d> vertices, std::vector<Eigen::Vector3d> normals);

  private:
    Geometry geometry_;
};

/// Returns the square z = 0, -1 <= x, y <= 1, facing +z, with (u, v) from (0, 0) to (1, 1).
MeshCore::Geometry rectangle();

/// Returns the cube -1 <= x, y, z <= 1, facing outwards, with (u, v) from (0, 0) to (1, 1) on each
/// side.
MeshCore::Geometry box();

}  // namespace rtrays
