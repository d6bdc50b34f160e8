// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/scene/cores/material_energy.h"

namespace rtrays {

const ParameterTable &common_material_parameters() {
    static const ParameterTable table = {
        {"two_sided", "false: black from behind, unless a component refracts", true},
        {"emission",
         "radiance leaving the front, W / (sr m^2), linear Rec. 709",
         Eigen::Vector3d(0, 0, 0),
         Parameter::Need::defaulted,
         ranges::not_negative,
         {},
         true},
        {"opacity",
         "share of the light that the surface stops; the rest passes straight through",
         1.0,
         Parameter::Need::defaulted,
         ranges::unit,
         {},
         true},
        {"opacity_cutoff", "if positive, opacities from here on count as 1 and lower ones as 0",
         0.0, Parameter::Need::defaulted, ranges::unit},
        {"normal_map",
         "factor of x and y of the normals of normal_map_texture",
         1.0,
         Parameter::Need::defaulted,
         ranges::any,
         {},
         true},
        {"bump_map",
         "factor of the heights of bump_map_texture, in scene units",
         1.0,
         Parameter::Need::defaulted,
         ranges::any,
         {},
         true},
        {"map_shadowing", "normal and bump maps shadow light that arrives at grazing angles", true},
        {"map_follows_v",
         "y of a normal map points along dp/dv, otherwise along the normal times dp/du", false},
        {"map_mirrored_back",
         "what a normal or bump map raises in front it also raises behind, otherwise it sinks",
         false},
    };
    return table;
}

void check_common_parameters(const ParameterSet &parameters) {
    const std::shared_ptr<Texture> texture = parameters.texture("opacity");
    const double largest =
        texture != nullptr ? static_cast<double>(texture->largest_texel().maxCoeff()) : 1;
    if (parameters.number("opacity") * largest > 1 + 1e-6) {
        throw input_error(fmt::format(
            "opacity: {} times the brightest texel of its texture, {:.6g}, exceeds 1; lower it",
            parameters.number("opacity"), largest));
    }
    if (parameters.texture("normal_map") != nullptr && parameters.texture("bump_map") != nullptr) {
        throw input_error("has normal_map_texture and bump_map_texture; remove one of them");
    }
}

void check_components(const std::vector<MaterialComponent> &components) {
    for (const MaterialComponent &component : components) {
        if (component.mix_texture != nullptr &&
            component.bxdf.mix * brightest_luminance(*component.mix_texture) > 1 + 1e-6) {
            throw input_error(
                fmt::format("the mix {} times the brightest texel of its texture, {:.6g}, exceeds "
                            "1; lower it",
                            component.bxdf.mix, brightest_luminance(*component.mix_texture)));
        }
        if (component.roughness_texture == nullptr) {
            continue;
        }
        const BxdfComponent &bxdf = component.bxdf;
        const double roughness = std::max(bxdf.alpha.maxCoeff(), bxdf.disney_roughness);
        if (roughness == 0) {
            throw input_error("a smooth surface takes no texture of its roughness; set roughness");
        }
        const auto brightest =
            static_cast<double>(component.roughness_texture->largest_texel().maxCoeff());
        const double factor = bxdf.roughness_squared ? brightest * brightest : brightest;
        if (roughness * factor > 1 + 1e-6) {
            throw input_error(
                fmt::format("the roughness {} times that of the brightest texel of its texture, "
                            "{:.6g}, exceeds 1; lower it",
                            roughness, factor));
        }
    }
    check_energy(components);
}

MaterialCore::MaterialCore(std::string name, const std::string &type, const ParameterValues &values,
                           const ParameterTextures &textures)
    : MaterialCore(std::move(name), static_type(find_type(material_types(), type, "material")),
                   values, textures) {}

MaterialCore::MaterialCore(std::string name, std::shared_ptr<const MaterialType> type,
                           const ParameterValues &values, const ParameterTextures &textures)
    : ParameterCore(std::move(name), std::move(type), values, textures) {
    attribute_.material = this;
    for (const auto &named : parameters().textures()) {
        named.second->users_.push_back(this);
    }
}

MaterialCore::~MaterialCore() {
    for (const auto &named : parameters().textures()) {
        std::vector<MaterialCore *> &users = named.second->users_;
        users.erase(std::find(users.begin(), users.end(), this));
    }
}

std::vector<MaterialComponent> MaterialCore::components() const {
    return static_cast<const MaterialType &>(type()).expand(parameters());
}

MaterialOpacity MaterialCore::opacity() const {
    MaterialOpacity made;
    made.value = parameters().number("opacity");
    made.cutoff = parameters().number("opacity_cutoff");
    return made;
}

NormalMap MaterialCore::normal_map() const {
    NormalMap made;
    if (normal_map_texture() == nullptr) {
        return made;
    }
    const bool has_normals = parameters().texture("normal_map") != nullptr;
    made.kind = has_normals ? NormalMap::Kind::normals : NormalMap::Kind::heights;
    made.scale = parameters().number(has_normals ? "normal_map" : "bump_map");
    made.shadowing = parameters().get<bool>("map_shadowing");
    made.follows_v = parameters().get<bool>("map_follows_v");
    made.mirrored_back = parameters().get<bool>("map_mirrored_back");
    return made;
}

std::shared_ptr<Texture> MaterialCore::normal_map_texture() const {
    const std::shared_ptr<Texture> normals = parameters().texture("normal_map");
    return normals != nullptr ? normals : parameters().texture("bump_map");
}

Dirty MaterialCore::outdated_by(const std::string &parameter) const {
    // The emission is part of the records of lights below the node, which also check the opacity.
    return parameter == "emission" || parameter == "opacity" || parameter == "opacity_cutoff"
               ? Dirty::subtree
               : Dirty::object;
}

}  // namespace rtrays
