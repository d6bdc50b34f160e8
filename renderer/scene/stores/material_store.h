// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "renderer/scene/store.h"

namespace rtrays {

class MaterialCore;
class Texture;

/// Textures have a record while a material's record refers to them.
class TextureStore {
  public:
    explicit TextureStore(TextureArrays &written) : arrays(written) {}

    /// Index of the texture's record, written if it is new or has changed; `no_index` for nullptr.
    uint32_t record(const std::shared_ptr<Texture> &texture);

    /// Drops the records that no component refers to and puts the new indices into the components.
    void keep_used(std::vector<BxdfComponent> &components);

    TextureArrays &arrays;

  private:
    std::unordered_map<const Texture *, uint32_t> slots_;
    std::vector<std::shared_ptr<Texture>> owners_;
    std::vector<uint64_t> version_;  ///< of the texture when the record was written
};

/// One record per material, however many nodes share it.
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
    std::vector<uint64_t> version_;  ///< of the core when the record was written
};

}  // namespace rtrays
