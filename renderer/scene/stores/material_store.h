// SPDX-License-Identifier: MIT
// The stores of materials and textures.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "renderer/scene/store.h"

namespace rtrays {

class MaterialCore;
class Texture;

/// One record per texture, which exists while a material's record refers to it.
class TextureStore {
  public:
    explicit TextureStore(TextureArrays &written) : arrays(written) {}

    /// Returns the index of the texture's record, or `no_index` for nullptr. Writes the record if
    /// it is new or the texture has changed.
    uint32_t record(const std::shared_ptr<Texture> &texture);

    /// Removes the records that no component, opacity, normal map or emission refers to, and
    /// updates the indices in the others.
    void keep_used(MaterialArrays &materials);

    TextureArrays &arrays;

  private:
    std::unordered_map<const Texture *, uint32_t> slots_;
    std::vector<std::shared_ptr<Texture>> owners_;
    std::vector<uint64_t> version_;  ///< version of the texture when the record was written
};

/// One record per material, which any number of nodes may share.
class MaterialStore : public Store {
  public:
    MaterialStore(MaterialArrays &written, TextureArrays &textures)
        : arrays(written), textures_(textures) {}
    const char *type_name() const override { return "materials"; }
    bool holds(const Core &core) const override { return core.role() == CoreRole::material; }
    bool concerns(const Node &node) const override {
        return node.core(CoreRole::material) != nullptr;
    }
    bool wants_record(const Node &, const AttributeSet &) const override { return true; }

    uint32_t slot_of_material(const MaterialCore *material) const;

    MaterialArrays &arrays;

  protected:
    const void *identity(const Node &node) const override { return node.core(CoreRole::material); }
    bool is_current(uint32_t slot, const Node &node) const override;
    void append(const Node &node) override;
    void write(uint32_t slot, const Node &node, const AttributeSet &attributes) override;
    void keep(const std::vector<uint32_t> &slots) override;

  private:
    TextureStore textures_;
    std::vector<uint64_t> version_;  ///< version of the core when the record was written
};

}  // namespace rtrays
