// SPDX-License-Identifier: MIT
// The store of meshes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "renderer/scene/store.h"

namespace rtrays {

class LightStore;
class MaterialStore;

/// One record per node with a mesh, baked to world space.
class MeshStore : public Store {
  public:
    MeshStore(MeshArrays &written, const MaterialStore &materials, const LightStore &lights)
        : arrays(written), materials_(materials), lights_(lights) {}
    const char *type_name() const override { return "meshes"; }
    bool holds(const Core &core) const override;
    bool concerns(const Node &node) const override;
    bool wants_record(const Node &node, const AttributeSet &attributes) const override;

    /// Clears the arrays of normals, coordinates and colours if no mesh uses them. Called after all
    /// objects of an update have been written.
    void drop_unused();

    /// Number of changes of positions or vertex indices.
    uint64_t geometry_version() const { return geometry_version_; }

    /// Number of changes of normals, texture coordinates, colours, materials or lights.
    uint64_t surface_version() const { return surface_version_; }

    /// Counts a change of materials that another store causes.
    void mark_surfaces() { ++surface_version_; }

    MeshArrays &arrays;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< origin of the baked world

  protected:
    bool fits(uint32_t slot, const Node &node) const override;
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;

  private:
    const MaterialStore &materials_;
    const LightStore &lights_;
    uint64_t geometry_version_ = 0;
    uint64_t surface_version_ = 0;
    size_t with_normals_ = 0;  ///< number of meshes with normals
    size_t with_uv_ = 0;       ///< number of meshes with texture coordinates
    size_t with_colours_ = 0;  ///< number of meshes with colours
};

}  // namespace rtrays
