// SPDX-License-Identifier: MIT
// The San Miguel model: a gzipped PLY of objects, a list of where they stand, and an MTL file.
//
// The list has lines "object ID NAME FIRST_TRIANGLE COUNT MATERIAL", with IDs from 0 on, and
// "instance OBJECT m00 .. m23", a row-major object-to-world matrix of 3 x 4.
#pragma once

#include <filesystem>

#include "renderer/scene/scene.h"
#include "renderer/tests/bvh_meshes.h"

namespace rtrays {

/// By the objects' names.
enum class SanMiguelPart { building_and_furniture, building_and_plants, whole };

/// All instances as triangles in world space: 2.26, 3.43 or 9.41 million. Throws `Error` (bad
/// input) naming file and line.
test::Mesh load_san_miguel(const std::filesystem::path &model,
                           const std::filesystem::path &instances, SanMiguelPart part);

/// The whole of it with normals, materials and textures, a mesh for each material, as other models
/// have them; without camera and lights, and not yet updated. `materials`: an MTL file, the n-th of
/// which is MATERIAL n. Throws as above.
Scene load_san_miguel_scene(const std::filesystem::path &model,
                            const std::filesystem::path &instances,
                            const std::filesystem::path &materials);

}  // namespace rtrays
