// SPDX-License-Identifier: MIT
// Compiles materials and textures into records, and collects the features that they use.
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>

#include "renderer/base/error.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/scene/cores/coat.h"

namespace rtrays {

namespace {

struct KindRow {
    uint32_t record_kind;
    Feature feature;
};

/// Rows are in the order of BxdfComponent::Kind.
constexpr std::array<KindRow, 13> kinds = {{
    {BXDF_LAMBERT, Feature::lambert},
    {BXDF_OREN_NAYAR, Feature::oren_nayar},
    {BXDF_IDEAL_REFLECTION, Feature::ideal_reflection},
    {BXDF_IDEAL_REFRACTION, Feature::ideal_refraction},
    {BXDF_BLINN, Feature::blinn},
    {BXDF_WARD, Feature::ward},
    {BXDF_WARD_ORIGINAL, Feature::ward_original},
    {BXDF_MICROFACET_REFLECTION, Feature::microfacet_reflection},
    {BXDF_MICROFACET_REFRACTION, Feature::microfacet_refraction},
    {BXDF_COATED_LAMBERT, Feature::coated_lambert},
    {BXDF_DISNEY_DIFFUSE, Feature::disney_diffuse},
    {BXDF_DISNEY_SHEEN, Feature::disney_sheen},
    {BXDF_DISNEY_CLEARCOAT, Feature::disney_clearcoat},
}};

/// First transmittances of coats.
using CoatTables = std::map<CoatKey, size_t>;

struct FresnelRow {
    uint32_t flag;
    Feature feature;
};

/// Rows are in the order of BxdfComponent::Fresnel.
constexpr std::array<FresnelRow, 6> fresnels = {{
    {FRESNEL_IDEAL, Feature::fresnel},  // needs no code
    {FRESNEL_DIELECTRIC, Feature::fresnel_dielectric},
    {FRESNEL_CONDUCTOR, Feature::fresnel_conductor},
    {FRESNEL_CONDUCTOR_APPROXIMATE, Feature::fresnel_conductor_approximate},
    {FRESNEL_SCHLICK, Feature::fresnel_schlick},
    {FRESNEL_THIN_DIELECTRIC, Feature::fresnel_thin_dielectric},
}};

bool is_delta(uint32_t kind) {
    return kind == BXDF_IDEAL_REFLECTION || kind == BXDF_IDEAL_REFRACTION;
}

bool is_diffuse(uint32_t kind) {
    return kind == BXDF_LAMBERT || kind == BXDF_OREN_NAYAR || kind == BXDF_COATED_LAMBERT ||
           kind == BXDF_DISNEY_DIFFUSE;
}

/// Returns whether a component is Lambert's without a Fresnel term.
bool is_plain_lambert(const BxdfRecord &component) {
    return component.kind == BXDF_LAMBERT && (component.flags & FRESNEL_MASK) == FRESNEL_IDEAL;
}

bool refracts(uint32_t kind) {
    return kind == BXDF_IDEAL_REFRACTION || kind == BXDF_MICROFACET_REFRACTION;
}

/// Compiles the fields of a base below a coat. Coats with the same parameters share a table.
void compile_coat(const BxdfComponent &component, BxdfRecord &record, CoatTables &tables,
                  CompiledScene &compiled) {
    const Coat coat{component.eta[0], component.alpha[0], component.distribution};
    const CoatKey key(coat.eta, coat.alpha, coat.distribution);
    CoatIntegrals &integrals = compiled.coat_integrals[key];
    double inner = component.inner_reflectance;
    if (inner < 0) {
        if (!integrals.inner_reflectance.has_value()) {
            integrals.inner_reflectance = coat_diffuse_reflectance(coat);
        }
        inner = *integrals.inner_reflectance;
    }
    const double factor = 1 / (coat.eta * coat.eta);
    record.parameter = static_cast<float>(component.nonlinear ? inner : 0);
    record.k[0] = static_cast<float>(component.nonlinear ? factor : factor / (1 - inner));
    if (coat.alpha == 0) {
        return;
    }
    if (integrals.transmittances.empty()) {
        for (uint32_t i = 0; i < COAT_NODES; ++i) {
            const double root = static_cast<double>(i) / (COAT_NODES - 1);
            integrals.transmittances.push_back(
                static_cast<float>(coat_transmittance(coat, root * root)));
        }
    }
    std::vector<float> &all = compiled.coat_transmittances;
    const auto [table, is_new] = tables.emplace(key, all.size());
    record.coat_or_roughness = static_cast<uint32_t>(table->second);
    if (is_new) {
        all.insert(all.end(), integrals.transmittances.begin(), integrals.transmittances.end());
    }
}

BxdfRecord compile_component(const BxdfComponent &component, FeatureMask &features) {
    const KindRow &kind = kinds[static_cast<size_t>(component.kind)];
    const FresnelRow &fresnel = fresnels[static_cast<size_t>(component.fresnel)];
    const bool beckmann = component.distribution == BxdfComponent::Distribution::beckmann;
    BxdfRecord record{};
    record.kind = kind.record_kind;
    record.flags = fresnel.flag | (component.complement ? BXDF_FLAG_COMPLEMENT : 0u) |
                   (component.fresnel_of_wo ? BXDF_FLAG_FRESNEL_OF_WO : 0u) |
                   (beckmann ? BXDF_FLAG_BECKMANN : 0u) |
                   (component.side == BxdfComponent::Side::front  ? BXDF_FLAG_FRONT_ONLY
                    : component.side == BxdfComponent::Side::back ? BXDF_FLAG_BACK_ONLY
                                                                  : 0u);
    record.texture = component.texture == no_index ? NO_TEXTURE : component.texture;
    record.parameter = static_cast<float>(
        component.kind == BxdfComponent::Kind::blinn ? component.exponent : component.sigma);
    record.alpha_x = static_cast<float>(component.alpha.x());
    record.alpha_y = static_cast<float>(component.alpha.y());
    copy3(component.weight, record.weight);
    copy3(component.eta, record.eta);
    copy3(component.k, record.k);
    if (component.kind == BxdfComponent::Kind::disney_diffuse) {
        record.parameter = static_cast<float>(component.disney_roughness);
        record.k[0] = static_cast<float>(component.flatness);
    }

    const bool microfacet =
        record.kind == BXDF_MICROFACET_REFLECTION || record.kind == BXDF_MICROFACET_REFRACTION;
    features = features.with(kind.feature);
    if (component.fresnel != BxdfComponent::Fresnel::ideal) {
        features = features.with(Feature::fresnel).with(fresnel.feature);
    }
    if (microfacet) {
        features = features.with(beckmann ? Feature::beckmann : Feature::ggx);
    }
    if (is_delta(record.kind)) {
        features = features.with(Feature::delta);
    }
    if (refracts(record.kind)) {
        features = features.with(Feature::refraction);
    }
    if (component.side != BxdfComponent::Side::both) {
        features = features.with(Feature::component_sides);
    }
    if (record.alpha_x != record.alpha_y) {
        features = features.with(Feature::tangents);
    }
    if (record.texture != NO_TEXTURE) {
        features = features.with(Feature::textures);
    }
    if (component.roughness_texture != no_index) {
        record.flags |= BXDF_FLAG_ROUGHNESS_TEXTURE |
                        (component.roughness_squared ? BXDF_FLAG_ROUGHNESS_SQUARED : 0u);
        record.coat_or_roughness = component.roughness_texture;
        features = features.with(Feature::textures).with(Feature::roughness_textures);
    }
    return record;
}

/// Compiles the mixture of a component, if it has one.
void compile_mix(const BxdfComponent &component, CompiledScene &compiled, BxdfRecord &record,
                 FeatureMask &features) {
    if (component.mix_texture == no_index) {
        return;
    }
    MixRecord mix{};
    mix.texture = component.mix_texture;
    mix.offset = component.mix_inverted ? 1.0f : 0.0f;
    mix.scale = static_cast<float>(component.mix_inverted ? -component.mix : component.mix);
    compiled.mixes.push_back(mix);
    const size_t number = compiled.mixes.size();
    if (number > std::numeric_limits<uint32_t>::max() >> BXDF_MIX_SHIFT) {
        throw input_error(fmt::format("the scene has more than {} textures of mixtures",
                                      std::numeric_limits<uint32_t>::max() >> BXDF_MIX_SHIFT));
    }
    record.flags |= static_cast<uint32_t>(number) << BXDF_MIX_SHIFT;
    features = features.with(Feature::textures).with(Feature::mixtures);
}

/// Compiles the map of a material, if it has one.
void compile_normal_map(const NormalMap &map, CompiledScene &compiled, MaterialRecord &material,
                        FeatureMask &features) {
    if (map.kind == NormalMap::Kind::none) {
        return;
    }
    const bool has_heights = map.kind == NormalMap::Kind::heights;
    NormalMapRecord record{};
    record.texture = map.texture;
    record.scale = static_cast<float>(map.scale);
    record.flags = (has_heights ? NORMAL_MAP_HEIGHTS : 0u) |
                   (map.shadowing ? NORMAL_MAP_SHADOWING : 0u) |
                   (map.follows_v ? NORMAL_MAP_FOLLOWS_V : 0u) |
                   (map.mirrored_back ? NORMAL_MAP_MIRRORED_BACK : 0u);
    material.flags |= MATERIAL_MAPPED;
    material.normal_map = static_cast<uint32_t>(compiled.normal_maps.size());
    compiled.normal_maps.push_back(record);
    features = features.with(Feature::normal_maps)
                   .with(Feature::bump_maps, has_heights || features.has(Feature::bump_maps))
                   .with(Feature::textures)
                   .with(Feature::tangents);
}

void compile_texture(const TextureArrays &textures, size_t index, CompiledScene &compiled) {
    const TextureImage &image = *textures.image[index];
    TextureRecord record = texture_record(textures, index);
    record.first_word = static_cast<uint32_t>(compiled.texels.size());
    compiled.textures.push_back(record);
    for (size_t i = 0; i + 2 < image.bytes.size(); i += 3) {
        compiled.texels.push_back(static_cast<uint32_t>(image.bytes[i]) |
                                  static_cast<uint32_t>(image.bytes[i + 1]) << 8 |
                                  static_cast<uint32_t>(image.bytes[i + 2]) << 16);
    }
    const size_t first = compiled.texels.size();
    compiled.texels.resize(first + image.floats.size());
    std::memcpy(compiled.texels.data() + first, image.floats.data(),
                image.floats.size() * sizeof(float));
}

}  // namespace

bool is_mirrored(const TextureArrays &textures, uint32_t index) {
    return index != no_index && textures.wrap[index] == TextureArrays::Wrap::mirror;
}

TextureRecord texture_record(const TextureArrays &textures, size_t index) {
    const TextureImage &image = *textures.image[index];
    TextureRecord record{};
    record.width = static_cast<uint32_t>(image.width);
    record.height = static_cast<uint32_t>(image.height);
    record.flags =
        (image.bytes.empty() ? TEXTURE_FLOAT : 0u) | (image.srgb ? TEXTURE_SRGB : 0u) |
        (textures.filter[index] == TextureArrays::Filter::bilinear ? TEXTURE_BILINEAR : 0u) |
        (textures.wrap[index] == TextureArrays::Wrap::clamp    ? TEXTURE_CLAMP
         : textures.wrap[index] == TextureArrays::Wrap::mirror ? TEXTURE_CLAMP | TEXTURE_MIRROR
                                                               : 0u) |
        (textures.has_vertex_colours(static_cast<uint32_t>(index)) ? TEXTURE_VERTEX_COLOURS : 0u);
    for (int i = 0; i < 2; ++i) {
        record.uv_scale[i] = static_cast<float>(textures.uv_scale[index][i]);
        record.uv_offset[i] = static_cast<float>(textures.uv_offset[index][i]);
    }
    return record;
}

void compile_materials(const SceneArrays &scene, CompiledScene &compiled) {
    const MaterialArrays &materials = scene.materials;
    FeatureMask features;
    CoatTables coats;
    for (size_t i = 0; i < materials.name.size(); ++i) {
        MaterialRecord record{};
        record.first_component = static_cast<uint32_t>(compiled.components.size());
        bool all_delta = true, any_diffuse = false;
        for (uint32_t c = 0; c < materials.component_count[i]; ++c) {
            const BxdfComponent &component = materials.component[materials.first_component[i] + c];
            if (!(component.weight.maxCoeff() > 0.0f)) {
                continue;  // a component without reflectance needs no code
            }
            BxdfRecord compiled_component = compile_component(component, features);
            if (is_mirrored(scene.textures, component.texture) ||
                is_mirrored(scene.textures, component.roughness_texture)) {
                features = features.with(Feature::texture_mirror);
            }
            compile_mix(component, compiled, compiled_component, features);
            if (is_mirrored(scene.textures, component.mix_texture)) {
                features = features.with(Feature::texture_mirror);
            }
            if (scene.textures.has_vertex_colours(component.texture)) {
                features = features.with(Feature::vertex_colours);
            }
            if (component.kind == BxdfComponent::Kind::coated_lambert) {
                compile_coat(component, compiled_component, coats, compiled);
            }
            record.flags |= refracts(compiled_component.kind) ? MATERIAL_BOUNDARY : 0u;
            record.flags |=
                compiled_component.alpha_x != compiled_component.alpha_y ? MATERIAL_TURNS : 0u;
            all_delta = all_delta && is_delta(compiled_component.kind);
            any_diffuse = any_diffuse || is_diffuse(compiled_component.kind);
            compiled.components.push_back(compiled_component);
        }
        record.component_count =
            static_cast<uint32_t>(compiled.components.size()) - record.first_component;
        record.flags |= (materials.two_sided[i] == 0 ? MATERIAL_ONE_SIDED : 0u) |
                        (all_delta ? MATERIAL_DELTA : 0u);
        record.flags |=
            any_diffuse && (record.flags & MATERIAL_BOUNDARY) == 0 ? MATERIAL_GUIDED : 0u;
        if (i < materials.normal_map.size() && record.component_count > 0) {
            compile_normal_map(materials.normal_map[i], compiled, record, features);
            if (is_mirrored(scene.textures, materials.normal_map[i].texture)) {
                features = features.with(Feature::texture_mirror);
            }
        }
        if (record.component_count == 1 && (record.flags & MATERIAL_MAPPED) == 0 &&
            is_plain_lambert(compiled.components.back())) {
            record.flags |= MATERIAL_LAMBERT;
        }
        features = features
                       .with(Feature::composite,
                             features.has(Feature::composite) || record.component_count != 1)
                       .with(Feature::one_sided,
                             features.has(Feature::one_sided) || materials.two_sided[i] == 0);
        compiled.materials.push_back(record);
    }
    for (const uint32_t texture : materials.emission_texture) {
        if (texture != no_index) {
            features = features.with(Feature::textures).with(Feature::emission_textures);
        }
        if (is_mirrored(scene.textures, texture)) {
            features = features.with(Feature::texture_mirror);
        }
    }
    features = features.with(Feature::scattering, !compiled.components.empty());
    compiled.material_features = features;
}

void compile_textures(const TextureArrays &textures, CompiledScene &compiled) {
    for (size_t i = 0; i < textures.name.size(); ++i) {
        compile_texture(textures, i, compiled);
    }
}

}  // namespace rtrays
