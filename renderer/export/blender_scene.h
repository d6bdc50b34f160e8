// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "renderer/export/export_settings.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Writes the scene as last updated, seen by its active camera, as a description (JSON) that
/// scripts/cycles_driver.py turns into a scene of Blender 3.4 and renders with Cycles. Meshes
/// (binary PLY) and images (EXR, linear) go to the folder NAME.blender_data beside
/// NAME.blender.json and replace files of the same names. The description itself is written last.
///
/// It says what the arrays say (stores.h), in the same units, axes and names: what Blender calls
/// them is the driver's affair. Coordinates are those of the baked world. Texels are decoded, so
/// that they are filtered as linear values: Cycles filters sRGB bytes before it decodes them.
///
/// Throws `Error` (bad input) naming object, component and what Cycles lacks for it, and `Error`
/// (run failed) naming a file that cannot be written.
void export_blender_scene(const Scene &scene, const std::filesystem::path &path,
                          const ExportSettings &settings = {});

}  // namespace rtrays
