// SPDX-License-Identifier: MIT
// A model file with the notices of its import, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/base/notice.h"
#include "renderer/import/load_scene.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// A scene that was loaded from a file, with the notices of its import.
struct LoadedModel {
    explicit LoadedModel(const std::filesystem::path &path) {
        const NoticeReceiver receiver([this](const std::string &text) { told += text + "\n"; });
        scene = load_scene(path.string());
    }

    bool says(const std::string &text) const { return told.find(text) != std::string::npos; }

    /// Returns the index of the material with that name.
    size_t material_index(const std::string &name) const {
        const std::vector<std::string> &names = scene.materials().name;
        const auto found = std::find(names.begin(), names.end(), name);
        EXPECT_NE(found, names.end()) << "unknown material " << name;
        return found == names.end() ? 0 : static_cast<size_t>(found - names.begin());
    }

    /// Returns the components of the material with that name.
    std::vector<BxdfComponent> material(const std::string &name) const {
        const MaterialArrays &m = scene.materials();
        const size_t at = material_index(name);
        const auto first = m.component.begin() + m.first_component[at];
        return {first, first + m.component_count[at]};
    }

    /// Returns the opacity of the material with that name.
    MaterialOpacity opacity(const std::string &name) const {
        return scene.materials().opacity[material_index(name)];
    }

    /// Returns the map of normals or heights of the material with that name.
    NormalMap normal_map(const std::string &name) const {
        return scene.materials().normal_map[material_index(name)];
    }

    /// Returns the texels of the image of that material's opacity, or nothing.
    std::vector<uint8_t> opacity_texels(const std::string &name) const {
        const uint32_t texture = opacity(name).texture;
        return texture == no_index ? std::vector<uint8_t>()
                                   : scene.arrays().textures.image[texture]->bytes;
    }

    /// Returns the index of the light whose node has that name.
    size_t light(const std::string &name) const {
        const auto &names = scene.lights().name;
        return static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    }

    std::string told;
    Scene scene;
};

}  // namespace rtrays
