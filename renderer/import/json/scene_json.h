// SPDX-License-Identifier: MIT
// Reader of scene files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "renderer/scene/scene.h"

namespace rtrays {

/// How a scene file is read.
struct SceneJsonOptions {
    /// Loads the scene of an "import"; without it, imports are errors.
    std::function<Scene(const std::filesystem::path &)> load_import;
    bool is_part = false;  ///< part of another scene, which needs no camera
};

/// Builds a scene from the text of a scene file and updates it to time 0. The format is described
/// in docs/scene-format.md and schema/scene.schema.json. Messages name `source_name`. The scene is
/// named `default_name` if the text gives no name. File names are relative to `directory`. Throws
/// `Error` (bad input) naming source, line, path and remedy.
Scene parse_scene_json(const std::string &text, const std::string &source_name,
                       const std::string &default_name,
                       const std::filesystem::path &directory = ".",
                       const SceneJsonOptions &options = {});

}  // namespace rtrays
