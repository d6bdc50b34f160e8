// SPDX-License-Identifier: MIT
// The store of shapes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/scene/store.h"

namespace rtrays {

class LightStore;
class MaterialStore;

/// One record per node with a shape.
class ShapeStore : public Store {
  public:
    ShapeStore(ShapeArrays &written, const MaterialStore &materials, const LightStore &lights)
        : arrays(written), materials_(materials), lights_(lights) {}
    const char *type_name() const override { return "shapes"; }
    bool holds(const Core &core) const override;
    bool concerns(const Node &node) const override;
    bool wants_record(const Node &node, const AttributeSet &attributes) const override;

    ShapeArrays &arrays;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< origin of the baked world

  protected:
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;

  private:
    const MaterialStore &materials_;
    const LightStore &lights_;
};

}  // namespace rtrays
