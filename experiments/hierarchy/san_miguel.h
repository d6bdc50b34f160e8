// SPDX-License-Identifier: MIT
// The San Miguel model: a gzipped PLY of objects, and a list of where they stand.
#pragma once

#include <filesystem>

#include "renderer/tests/bvh_meshes.h"

namespace rtrays {

/// By the objects' names.
enum class SanMiguelPart { building_and_furniture, building_and_plants, whole };

/// All instances as triangles in world space: 2.26, 3.43 or 9.41 million. `model` holds the triangles of the
/// objects; `instances` has lines "object ID NAME FIRST_TRIANGLE COUNT MATERIAL" and "instance OBJECT m00 ..
/// m23", a row-major object-to-world matrix of 3 x 4. Throws `Error` (bad input) naming file and line.
test::Mesh load_san_miguel(const std::filesystem::path &model, const std::filesystem::path &instances,
                           SanMiguelPart part);

}  // namespace rtrays
