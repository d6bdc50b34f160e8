// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "renderer/scene/scene.h"

namespace rtrays {

/// Builds a scene from the text of a Mitsuba 3 scene file (Jakob et al. 2022, "Mitsuba 3 renderer";
/// format and defaults as of version 3.9), ready to be read at time 0. What maps to our model is
/// listed in scenes/README.md. `source_name` stands in messages, `default_name` is the scene's
/// name; files are found relative to `directory`.
///
/// Integrator, sampler, reconstruction filter and clipping planes are replaced by ours, with a
/// `notice`. Throws `Error` (bad input) naming source, line and element for everything else that is
/// unknown, malformed or cannot be mapped.
Scene parse_mitsuba_xml(const std::string &text, const std::string &source_name,
                        const std::string &default_name,
                        const std::filesystem::path &directory = ".");

}  // namespace rtrays
