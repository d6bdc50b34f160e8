// SPDX-License-Identifier: MIT
// The material that a MaterialReader makes.
#pragma once

#include "renderer/import/mitsuba/bsdf.h"

namespace rtrays::mitsuba {

/// A material under construction.
struct MaterialReader::Draft {
    UvConvention uv;
    std::shared_ptr<const MaterialType> type;
    ParameterValues values;
    ParameterTextures textures;
    ErrorList *errors;
    bool depends_on_uv = false;

    bool has_opacity() const { return values.count("opacity") + textures.count("opacity") > 0; }
    bool has_map() const { return textures.count("normal_map") + textures.count("bump_map") > 0; }

    void set_type(const char *name) {
        type = static_type(find_type(material_types(), name, "material"));
    }
};

}  // namespace rtrays::mitsuba
