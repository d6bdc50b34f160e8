// SPDX-License-Identifier: MIT
// The store of cameras.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/scene/store.h"

namespace rtrays {

/// One record per node with a camera. Cameras cannot be hidden.
class CameraStore : public Store {
  public:
    explicit CameraStore(CameraArrays &written) : arrays(written) {}
    const char *type_name() const override { return "cameras"; }
    bool holds(const Core &core) const override { return core.role() == CoreRole::camera; }
    bool concerns(const Node &node) const override {
        return node.core(CoreRole::camera) != nullptr;
    }
    bool wants_record(const Node &, const AttributeSet &) const override { return true; }

    CameraArrays &arrays;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< origin of the baked world

  protected:
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;
};

}  // namespace rtrays
