// SPDX-License-Identifier: MIT
// The stores of each serializable type. What their records mean is said in stores.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/scene/store.h"
#include "renderer/scene/stores.h"

namespace rtrays {

class MaterialCore;

class CameraStore : public Store {
  public:
    explicit CameraStore(CameraArrays &written) : Store(CoreRole::camera), arrays(written) {}
    const char *type_name() const override { return "cameras"; }

    CameraArrays &arrays;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the baked world

  protected:
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;
};

/// One record per material, however many nodes share it.
class MaterialStore : public Store {
  public:
    explicit MaterialStore(MaterialArrays &written) : Store(CoreRole::material), arrays(written) {}
    const char *type_name() const override { return "materials"; }

    uint32_t slot_of_material(const MaterialCore *material) const;

    MaterialArrays &arrays;

  protected:
    const void *identity(const Node &node) const override;
    bool is_current(uint32_t slot, const Node &node) const override;
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;

  private:
    std::vector<uint64_t> version_;  ///< of the core when the record was written
};

class LightStore;

class MeshStore : public Store {
  public:
    MeshStore(MeshArrays &written, const MaterialStore &materials, const LightStore &lights)
        : Store(CoreRole::geometry), arrays(written), materials_(materials), lights_(lights) {}
    const char *type_name() const override { return "meshes"; }

    MeshArrays &arrays;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the baked world

  protected:
    bool fits(uint32_t slot, const Node &node) const override;
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;

  private:
    const MaterialStore &materials_;
    const LightStore &lights_;
};

/// To be written after the meshes: areas are those of the baked triangles.
class LightStore : public Store {
  public:
    LightStore(LightArrays &written, const MeshStore &meshes)
        : Store(CoreRole::light), arrays(written), meshes_(meshes) {}
    const char *type_name() const override { return "lights"; }

    LightArrays &arrays;

  protected:
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;

  private:
    const MeshStore &meshes_;
};

}  // namespace rtrays
