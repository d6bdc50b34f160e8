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

    /// Returns the components of the material with that name.
    std::vector<BxdfComponent> material(const std::string &name) const {
        const MaterialArrays &m = scene.materials();
        const auto found = std::find(m.name.begin(), m.name.end(), name);
        if (found == m.name.end()) {
            ADD_FAILURE() << "unknown material " << name;
            return {};
        }
        const auto at = static_cast<size_t>(found - m.name.begin());
        const auto first = m.component.begin() + m.first_component[at];
        return {first, first + m.component_count[at]};
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
