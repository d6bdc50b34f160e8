// SPDX-License-Identifier: MIT
// Reads the San Miguel model: a gzipped PLY file of objects, a list of their instances, and an MTL
// file.
//
// The list has lines "object ID NAME FIRST_TRIANGLE COUNT MATERIAL", with IDs from 0, and lines
// "instance OBJECT m00 .. m23" with a row-major object-to-world matrix of 3 x 4.
#pragma once

#include <filesystem>

#include "renderer/scene/scene.h"
#include "renderer/testing/bvh_meshes.h"

namespace rtrays {

/// Parts of the model, selected by the names of the objects.
enum class SanMiguelPart { building_and_furniture, building_and_plants, whole };

/// Loads all instances of a part as triangles in world space: 2.26, 3.43 or 9.41 million. Throws
/// `Error` (bad input) naming the file and the line.
test::Mesh load_san_miguel(const std::filesystem::path &model,
                           const std::filesystem::path &instances, SanMiguelPart part);

/// Loads the full model with normals, materials and textures, with one mesh for each material, as
/// for other models. The scene has no camera and no lights and is not yet updated. `materials` is
/// an MTL file, whose n-th material is MATERIAL n, from 0. Throws `Error` (bad input) naming the
/// file and the line.
Scene load_san_miguel_scene(const std::filesystem::path &model,
                            const std::filesystem::path &instances,
                            const std::filesystem::path &materials);

}  // namespace rtrays
