// SPDX-License-Identifier: MIT
// A function that the stores of meshes and shapes share.
#pragma once

#include <fmt/format.h>

#include <string>

#include "renderer/base/error.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/stores/material_store.h"

namespace rtrays {

/// Returns the record of the material that has accumulated at geometry. Throws `Error` (bad input)
/// if there is none.
inline uint32_t material_slot(const MaterialStore &materials, const AttributeSet &attributes,
                              const char *what, const std::string &name) {
    const uint32_t slot = materials.slot_of_material(attributes.get<MaterialAttribute>().material);
    if (slot == no_index) {
        throw input_error(fmt::format(
            "{} '{}' has no material; assign one to its node or to a node above", what, name));
    }
    return slot;
}

}  // namespace rtrays
