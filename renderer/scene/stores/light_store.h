// SPDX-License-Identifier: MIT
// The store of lights.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/scene/store.h"

namespace rtrays {

class MeshStore;
class ShapeStore;

/// One record per node with a light core, or with geometry of an emissive material. Must be written
/// after the geometry, because areas are those of the baked geometry.
class LightStore : public Store {
  public:
    LightStore(LightArrays &written, const MeshStore &meshes, const ShapeStore &shapes)
        : arrays(written), meshes_(meshes), shapes_(shapes) {}
    const char *type_name() const override { return "lights"; }
    bool holds(const Core &core) const override;
    bool concerns(const Node &node) const override;
    bool wants_record(const Node &node, const AttributeSet &attributes) const override;

    /// Returns the record of the area light on the geometry of `node`, or `no_index`.
    uint32_t area_light_slot(const Node &node, const AttributeSet &attributes) const;

    LightArrays &arrays;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< origin of the baked world

  protected:
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;

  private:
    void write_area(uint32_t slot, const Node &node);
    double mesh_area(uint32_t mesh) const;
    double shape_area(uint32_t shape, const std::string &name) const;

    const MeshStore &meshes_;
    const ShapeStore &shapes_;
};

}  // namespace rtrays
