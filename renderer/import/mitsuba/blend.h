// SPDX-License-Identifier: MIT
// Sums of materials, for Mitsuba's "blendbsdf".
#pragma once

#include <vector>

#include "renderer/scene/cores/material.h"

namespace rtrays::mitsuba {

/// A composite material: its type, parameters and textures.
struct Composite {
    std::shared_ptr<const MaterialType> type;
    ParameterValues values;
    ParameterTextures textures;
};

/// Returns the material of these components. Their weights are parameters of the composite. Its
/// energy is not checked: the components of a plastic may exceed 1 below their Fresnel terms.
Composite composite_of(const std::vector<MaterialComponent> &components);

}  // namespace rtrays::mitsuba
