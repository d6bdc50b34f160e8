// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/light.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

DiffuseAreaLight::DiffuseAreaLight(std::string name, const Eigen::Vector3d &radiance)
    : Core(std::move(name)) {
    set_radiance(radiance);
}

void DiffuseAreaLight::set_radiance(const Eigen::Vector3d &radiance) {
    constexpr double largest = std::numeric_limits<float>::max();
    // Written so that NaN fails.
    if (!((radiance.array() >= 0).all() && (radiance.array() <= largest).all())) {
        throw input_error(fmt::format("radiance: [{}, {}, {}] is not within [0, {}]", radiance[0],
                                      radiance[1], radiance[2], largest));
    }
    radiance_ = radiance;
    changed();
}

std::vector<Property> DiffuseAreaLight::properties() {
    return {make_property<Eigen::Vector3d>(
        "radiance", "radiance leaving the front, W / (sr m^2), linear Rec. 709", [this] { return radiance_; },
        [this](const Eigen::Vector3d &value) { set_radiance(value); })};
}

}  // namespace rtrays
