// SPDX-License-Identifier: MIT
// Export of a scene to Blender's Cycles.
#pragma once

#include <filesystem>

#include "renderer/export/export_settings.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Writes the scene as last updated, seen by its active camera, as a JSON description.
/// scripts/rtrays/peers/cycles_driver.py builds a scene of Blender 3.4 from it and renders that
/// with Cycles. Meshes (binary PLY) and images (EXR, linear) go to the folder NAME.blender_data
/// beside NAME.blender.json and replace files of the same names. The description itself is written
/// last.
///
/// The description has the content of the arrays (stores.h), with their units, axes and names; the
/// driver translates it to Blender's terms. Coordinates are those of the baked world. Texels are
/// decoded, so that they are filtered as linear values: Cycles filters sRGB bytes before it decodes
/// them.
///
/// Throws `Error` (bad input) naming the object, the component and the feature that Cycles lacks,
/// and `Error` (run failed) naming a file that cannot be written.
void export_blender_scene(const Scene &scene, const std::filesystem::path &path,
                          const ExportSettings &settings = {});

}  // namespace rtrays
