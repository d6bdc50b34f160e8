// SPDX-License-Identifier: MIT
#include "renderer/scene/stores/material_store.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/scene/cores/material.h"

namespace rtrays {

uint32_t TextureStore::record(const std::shared_ptr<Texture> &texture) {
    if (texture == nullptr) {
        return no_index;
    }
    const auto [found, is_new] =
        slots_.try_emplace(texture.get(), static_cast<uint32_t>(owners_.size()));
    const uint32_t slot = found->second;
    if (is_new) {
        owners_.push_back(texture);
        version_.push_back(0);
        arrays.name.push_back(texture->name());
        arrays.image.push_back(texture->image());
        arrays.filter.emplace_back();
        arrays.wrap.emplace_back();
        arrays.uv_scale.emplace_back();
        arrays.uv_offset.emplace_back();
        arrays.vertex_colours.emplace_back();
    }
    if (version_[slot] != texture->version()) {
        const ParameterSet &p = texture->parameters();
        arrays.filter[slot] = p.choice<TextureArrays::Filter>("filter");
        arrays.wrap[slot] = p.choice<TextureArrays::Wrap>("wrap");
        arrays.uv_scale[slot] = p.get<Eigen::Vector2d>("uv_scale");
        arrays.uv_offset[slot] = p.get<Eigen::Vector2d>("uv_offset");
        arrays.vertex_colours[slot] = p.get<bool>("vertex_colours") ? 1 : 0;
        version_[slot] = texture->version();
    }
    return slot;
}

void TextureStore::keep_used(MaterialArrays &materials) {
    std::vector<uint32_t> new_index(owners_.size(), no_index);
    const auto for_each_use = [&](const auto &visit) {
        for (BxdfComponent &component : materials.component) {
            visit(component.texture);
            visit(component.roughness_texture);
            visit(component.mix_texture);
        }
        for (MaterialOpacity &opacity : materials.opacity) {
            visit(opacity.texture);
        }
        for (NormalMap &map : materials.normal_map) {
            visit(map.texture);
        }
        for (uint32_t &texture : materials.emission_texture) {
            visit(texture);
        }
    };
    for_each_use([&](uint32_t texture) {
        if (texture != no_index) {
            new_index[texture] = 0;
        }
    });
    std::vector<uint32_t> kept;
    for (uint32_t old = 0; old < new_index.size(); ++old) {
        if (new_index[old] != no_index) {
            new_index[old] = static_cast<uint32_t>(kept.size());
            slots_[owners_[old].get()] = new_index[old];
            kept.push_back(old);
        } else {
            slots_.erase(owners_[old].get());
        }
    }
    for_each_use(
        [&](uint32_t &texture) { texture = texture == no_index ? no_index : new_index[texture]; });
    keep_elements(owners_, kept);
    keep_elements(version_, kept);
    keep_elements(arrays.name, kept);
    keep_elements(arrays.image, kept);
    keep_elements(arrays.filter, kept);
    keep_elements(arrays.wrap, kept);
    keep_elements(arrays.uv_scale, kept);
    keep_elements(arrays.uv_offset, kept);
    keep_elements(arrays.vertex_colours, kept);
}

namespace {

/// Throws if the colours of vertices multiply a texture that is no weight of a component.
void check_vertex_colours(const MaterialCore &material) {
    const auto check = [&](const std::shared_ptr<Texture> &texture, const char *what) {
        if (texture != nullptr && texture->has_vertex_colours()) {
            throw input_error(fmt::format(
                "material '{}': texture '{}' of its {} has vertex_colours, which only textures of "
                "reflectances and transmittances may have",
                material.name(), texture->name(), what));
        }
    };
    for (const MaterialComponent &component : material.components()) {
        check(component.roughness_texture, "roughness");
        check(component.mix_texture, "mixture");
    }
    check(material.opacity_texture(), "opacity");
    check(material.normal_map_texture(), "normals");
    check(material.emission_texture(), "emission");
}

}  // namespace

uint32_t MaterialStore::slot_of_material(const MaterialCore *material) const {
    return slot_of(static_cast<const Core *>(material));
}

bool MaterialStore::is_current(uint32_t slot, const Node &node) const {
    return version_[slot] == node.core(CoreRole::material)->version();
}

void MaterialStore::append(const Node &node) {
    const auto &material = static_cast<const MaterialCore &>(*node.core(CoreRole::material));
    const auto count = static_cast<uint32_t>(material.components().size());
    arrays.name.push_back(material.name());
    arrays.first_component.push_back(static_cast<uint32_t>(arrays.component.size()));
    arrays.component_count.push_back(count);
    arrays.component.resize(arrays.component.size() + count);
    arrays.two_sided.push_back(1);
    arrays.opacity.emplace_back();
    arrays.normal_map.emplace_back();
    arrays.emission_texture.push_back(no_index);
    version_.push_back(0);
}

void MaterialStore::write(uint32_t slot, const Node &node, const AttributeSet &) {
    const auto &material = static_cast<const MaterialCore &>(*node.core(CoreRole::material));
    check_vertex_colours(material);
    uint32_t at = arrays.first_component[slot];
    // The number of components has not changed since `append`.
    for (const MaterialComponent &component : material.components()) {
        arrays.component[at] = component.bxdf;
        arrays.component[at].texture = textures_.record(component.texture);
        arrays.component[at].roughness_texture = textures_.record(component.roughness_texture);
        arrays.component[at].mix_texture = textures_.record(component.mix_texture);
        ++at;
    }
    arrays.two_sided[slot] = material.two_sided() ? 1 : 0;
    arrays.opacity[slot] = material.opacity();
    arrays.opacity[slot].texture = textures_.record(material.opacity_texture());
    arrays.normal_map[slot] = material.normal_map();
    arrays.normal_map[slot].texture = textures_.record(material.normal_map_texture());
    const NormalMap &map = arrays.normal_map[slot];
    if (map.kind == NormalMap::Kind::heights &&
        textures_.arrays.wrap[map.texture] == TextureArrays::Wrap::mirror) {
        throw input_error(fmt::format(
            "material '{}': a bump map cannot be mirrored beyond its edges; use repeat or clamp",
            material.name()));
    }
    arrays.emission_texture[slot] = textures_.record(material.emission_texture());
    version_[slot] = material.version();
}

void MaterialStore::keep(const std::vector<uint32_t> &slots) {
    std::vector<BxdfComponent> components;
    for (const uint32_t slot : slots) {
        const auto first = arrays.component.begin() + arrays.first_component[slot];
        arrays.first_component[slot] = static_cast<uint32_t>(components.size());
        components.insert(components.end(), first, first + arrays.component_count[slot]);
    }
    arrays.component = std::move(components);
    keep_elements(arrays.opacity, slots);
    keep_elements(arrays.normal_map, slots);
    keep_elements(arrays.emission_texture, slots);
    textures_.keep_used(arrays);
    keep_elements(arrays.name, slots);
    keep_elements(arrays.first_component, slots);
    keep_elements(arrays.component_count, slots);
    keep_elements(arrays.two_sided, slots);
    keep_elements(version_, slots);
}

}  // namespace rtrays
