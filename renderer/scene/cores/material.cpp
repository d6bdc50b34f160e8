// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/material.h"

#include <algorithm>
#include <utility>

namespace rtrays {

const ParameterTable &common_material_parameters() {
    static const ParameterTable table = {
        {"two_sided", "false: black from behind, unless a component refracts", true},
        {"emission", "radiance leaving the front, W / (sr m^2), linear Rec. 709",
         Eigen::Vector3d(0, 0, 0), Parameter::Need::defaulted, ranges::not_negative},
    };
    return table;
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

Dirty MaterialCore::outdated_by(const std::string &parameter) const {
    // The emission is part of the records of lights below the node.
    return parameter == "emission" ? Dirty::subtree : Dirty::object;
}

}  // namespace rtrays
