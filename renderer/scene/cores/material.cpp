// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/material.h"

#include <fmt/format.h>

#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

LambertMaterial::LambertMaterial(std::string name, const Eigen::Vector3d &reflectance)
    : MaterialCore(std::move(name)) {
    set_reflectance(reflectance);
}

void LambertMaterial::set_reflectance(const Eigen::Vector3d &reflectance) {
    // Written so that NaN fails.
    if (!((reflectance.array() >= 0).all() && (reflectance.array() <= 1).all())) {
        throw input_error(fmt::format("reflectance: [{}, {}, {}] is not within [0, 1]", reflectance[0],
                                      reflectance[1], reflectance[2]));
    }
    reflectance_ = reflectance;
    changed();
}

std::vector<Property> LambertMaterial::properties() {
    return {make_property<Eigen::Vector3d>(
        "reflectance", "albedo, linear Rec. 709, within [0, 1]", [this] { return reflectance_; },
        [this](const Eigen::Vector3d &value) { set_reflectance(value); })};
}

}  // namespace rtrays
