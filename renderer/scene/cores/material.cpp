// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

const ParameterTable &common_material_parameters() {
    static const ParameterTable table = {
        {"two_sided", "false: black from behind, unless a component refracts", true},
        {"emission", "radiance leaving the front, W / (sr m^2), linear Rec. 709",
         Eigen::Vector3d(0, 0, 0), Parameter::Need::defaulted, ranges::not_negative},
        {"opacity",
         "share of the light that the surface stops; the rest passes straight through",
         1.0,
         Parameter::Need::defaulted,
         ranges::unit,
         {},
         true},
        {"opacity_cutoff", "if positive, opacities from here on count as 1 and lower ones as 0",
         0.0, Parameter::Need::defaulted, ranges::unit},
    };
    return table;
}

void check_opacity(const ParameterSet &parameters) {
    const std::shared_ptr<Texture> texture = parameters.texture("opacity");
    const double largest =
        texture != nullptr ? static_cast<double>(texture->largest_texel().maxCoeff()) : 1;
    if (parameters.number("opacity") * largest > 1 + 1e-6) {
        throw input_error(fmt::format(
            "opacity: {} times the brightest texel of its texture, {:.6g}, exceeds 1; lower it",
            parameters.number("opacity"), largest));
    }
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

Dirty MaterialCore::outdated_by(const std::string &parameter) const {
    // The emission is part of the records of lights below the node, which also check the opacity.
    return parameter == "emission" || parameter == "opacity" || parameter == "opacity_cutoff"
               ? Dirty::subtree
               : Dirty::object;
}

}  // namespace rtrays
