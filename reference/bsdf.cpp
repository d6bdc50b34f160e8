// SPDX-License-Identifier: MIT
#include "reference/bsdf.h"

#include <fmt/format.h>

#include "renderer/base/error.h"

namespace rtrays::reference {

std::vector<Bsdf> make_bsdfs(const MaterialArrays &materials) {
    std::vector<Bsdf> bsdfs;
    for (size_t i = 0; i < materials.name.size(); ++i) {
        const BxdfComponent &component = materials.component[materials.first_component[i]];
        if (materials.component_count[i] != 1 || component.kind != BxdfComponent::Kind::lambert) {
            throw input_error(fmt::format("material {} '{}': the reference does not know its kind", i,
                                          materials.name[i]));
        }
        const Spectrum albedo = component.weight.cast<double>();
        if (!(albedo >= 0.0).all() || !(albedo <= 1.0).all()) {
            throw input_error(
                fmt::format("material {} '{}': reflectance must lie in [0, 1]", i, materials.name[i]));
        }
        bsdfs.emplace_back(Lambert(albedo));
    }
    return bsdfs;
}

}  // namespace rtrays::reference
