// SPDX-License-Identifier: MIT
// Composite materials: sums of BxDFs with Fresnel terms that the scene file chooses.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/scene/cores/material.h"

namespace rtrays {

/// Kinds of BxDF and Fresnel term of one component of a composite, by their names in scene files.
struct CompositePart {
    std::string bxdf;               ///< "lambert", "microfacet_reflection", ...
    std::string fresnel = "ideal";  ///< "dielectric", "conductor", ...
};

/// Return the names, in the order of `BxdfComponent::Kind`, `Fresnel` and `Side`.
const std::vector<std::string> &bxdf_names();
const std::vector<std::string> &fresnel_names();
const std::vector<std::string> &side_names();

/// Returns the prefix of the names of a component's parameters: "component_0_" and so on. The
/// parameters of its Fresnel term begin with "component_0_fresnel_".
std::string part_prefix(size_t index);

/// Returns the type of a composite of these components. Throws `Error` (bad input) if there is no
/// component, a kind is unknown (listing the names), or a kind does not support a Fresnel term.
std::shared_ptr<const MaterialType> composite_type(const std::vector<CompositePart> &parts);

}  // namespace rtrays
