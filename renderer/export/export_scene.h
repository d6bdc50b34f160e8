// SPDX-License-Identifier: MIT
// Export of scenes to other renderers, chosen by the file name.
#pragma once

#include <filesystem>

#include "renderer/export/export_settings.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Writes the scene for the renderer that the file name denotes: NAME.xml for Mitsuba 3
/// (mitsuba_xml.h), NAME.blender.json for Blender's Cycles (blender_scene.h). Throws the errors of
/// these exporters, and `Error` (bad usage) listing the endings for any other name.
void export_scene(const Scene &scene, const std::filesystem::path &path,
                  const ExportSettings &settings = {});

/// Checks only the name, before the scene is loaded. Throws `Error` (bad usage) listing the
/// endings.
void require_export_name(const std::filesystem::path &path);

}  // namespace rtrays
