// SPDX-License-Identifier: MIT
// Reader of scene files.
#pragma once

#include <filesystem>
#include <string>

#include "renderer/scene/scene.h"

namespace rtrays {

/// Builds a scene from the text of a scene file and updates it to time 0. The format is described
/// in docs/scene-format.md and schema/scene.schema.json. Messages name `source_name`. The scene is
/// named `default_name` if the text gives no name. File names are relative to `directory`. Throws
/// `Error` (bad input) naming source, line, path and remedy.
Scene parse_scene_json(const std::string &text, const std::string &source_name,
                       const std::string &default_name,
                       const std::filesystem::path &directory = ".");

}  // namespace rtrays
