// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "renderer/scene/scene.h"

namespace rtrays {

/// Builds a scene from the text of a scene file (format: scenes/README.md,
/// schema/scene.schema.json), ready to be read at time 0. `source_name` stands in messages;
/// `default_name` is the scene's name if the text has none; images are found relative to
/// `directory`. Throws `Error` (bad input) naming source, line, path and remedy.
Scene parse_scene_json(const std::string &text, const std::string &source_name,
                       const std::string &default_name,
                       const std::filesystem::path &directory = ".");

}  // namespace rtrays
