// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/scene/cores/material.h"

namespace rtrays {

/// The kinds of one component of a composite material, by the names of scene files.
struct CompositePart {
    std::string bxdf;               ///< "lambert", "microfacet_reflection", ...
    std::string fresnel = "ideal";  ///< "dielectric", "conductor", ...
};

/// Names in the order of `BxdfComponent::Kind` and `BxdfComponent::Fresnel`.
const std::vector<std::string> &bxdf_names();
const std::vector<std::string> &fresnel_names();

/// Beginning of the parameters' names of one component: "component_0_" and so on. Those of its
/// Fresnel term begin with "component_0_fresnel_".
std::string part_prefix(size_t index);

/// The type of a composite of these components. Throws `Error` (bad input) listing the names when a
/// kind is unknown, when there is no component, and where a kind does not go with a Fresnel term.
std::shared_ptr<const MaterialType> composite_type(const std::vector<CompositePart> &parts);

}  // namespace rtrays
