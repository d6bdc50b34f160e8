// SPDX-License-Identifier: MIT
// Export of a scene to Mitsuba 3.
#pragma once

#include <filesystem>

#include "renderer/export/export_settings.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Writes the scene as last updated, seen by its active camera, as a Mitsuba 3 scene file. Meshes
/// (binary PLY) and images (PNG, or EXR) go to the folder NAME_data beside NAME.xml and replace
/// files of the same names. The scene file itself is written last.
///
/// Throws `Error` (bad input) naming the object that Mitsuba cannot represent, and `Error` (run
/// failed) naming a file that cannot be written.
void export_mitsuba_xml(const Scene &scene, const std::filesystem::path &path,
                        const ExportSettings &settings = {});

}  // namespace rtrays
