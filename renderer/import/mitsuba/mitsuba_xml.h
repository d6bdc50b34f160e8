// SPDX-License-Identifier: MIT
// Reader of Mitsuba 3 scene files.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "renderer/scene/scene.h"

namespace rtrays {

/// Builds a scene from the text of a Mitsuba scene file, version 0.4 or later, and updates it to
/// time 0 (Jakob et al. 2022, "Mitsuba 3 renderer"; format and defaults as of version 3.9).
/// docs/importers.md lists the supported elements. Messages name `source_name`. The scene is named
/// `default_name`. Relative file names are searched in `directory` and in the folders of "path"
/// elements. `defines` are values of parameters ("$name"). Part of another scene needs no sensor.
///
/// Integrator, sampler, reconstruction filter and clipping planes are replaced by this renderer's
/// own, with a `notice`. Throws `Error` (bad input) naming source, line and element for everything
/// else that is unknown, malformed or unsupported. One error lists all faults of the file.
Scene parse_mitsuba_xml(const std::string &text, const std::string &source_name,
                        const std::string &default_name,
                        const std::filesystem::path &directory = ".",
                        const std::map<std::string, std::string> &defines = {},
                        bool is_part = false);

}  // namespace rtrays
