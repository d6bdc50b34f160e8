// SPDX-License-Identifier: MIT
// Recognises components as those of Mitsuba's principled BSDF.
#pragma once

#include <optional>
#include <vector>

#include "renderer/import/mitsuba/principled.h"
#include "renderer/scene/stores.h"

namespace rtrays::mitsuba {

/// A principled BSDF whose textures are those of a scene.
struct PrincipledBsdf {
    Principled parameters;  ///< with textures where there are indices
    uint32_t base_texture = no_index, roughness_texture = no_index;
};

/// Returns the principled BSDF that the importer reads as these components, or nothing if there is
/// none. Weights and reflectances may differ by rounding. Sides are ignored.
std::optional<PrincipledBsdf> principled_of(const std::vector<BxdfComponent> &parts,
                                            const TextureArrays &textures);

}  // namespace rtrays::mitsuba
