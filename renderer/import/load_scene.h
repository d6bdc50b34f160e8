// SPDX-License-Identifier: MIT
// Loading of scene files of every supported format.
#pragma once

#include <string>

#include "renderer/scene/scene.h"

namespace rtrays {

/// Loads a scene, from JSON, from a Mitsuba file or from a model file (models/model_file.h), and
/// updates it to time 0. Prints progress on stderr unless `quiet`. Throws `Error` (bad input)
/// naming file, line and remedy.
Scene load_scene(const std::string &path, bool quiet = true);

}  // namespace rtrays
