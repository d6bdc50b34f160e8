// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "renderer/export/export_settings.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Writes the scene for the renderer that the file name stands for: NAME.xml for Mitsuba 3
/// (mitsuba_xml.h), NAME.blender.json for Blender's Cycles (blender_scene.h). Throws `Error` as
/// those do, and `Error` (bad usage) listing the endings when it is none of them.
void export_scene(const Scene &scene, const std::filesystem::path &path,
                  const ExportSettings &settings = {});

/// The check of the name alone, for before the scene is loaded.
void require_export_name(const std::filesystem::path &path);

}  // namespace rtrays
