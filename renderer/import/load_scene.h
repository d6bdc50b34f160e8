// SPDX-License-Identifier: MIT
// Loading of scene files of every supported format.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace rtrays {

/// Loads a scene, from JSON, from a Mitsuba file or from a model file (models/model_file.h), and
/// updates it to time 0. A JSON file with "base" is an overlay: that scene with other values of
/// properties (json/schema/overlay.schema.json). Prints progress on stderr unless `quiet`. Throws
/// `Error` (bad input) naming file, line and remedy.
/// `defines` are values of the parameters of a Mitsuba file. Other formats have none.
Scene load_scene(const std::string &path, bool quiet = true,
                 const std::map<std::string, std::string> &defines = {});

/// Parses NAME=VALUE texts of the option --define. Throws `Error` (bad usage) for any other text.
std::map<std::string, std::string> parse_defines(const std::vector<std::string> &texts);

}  // namespace rtrays
