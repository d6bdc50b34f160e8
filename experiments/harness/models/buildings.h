// SPDX-License-Identifier: MIT
// Procedural architecture that replaces missing models.
#pragma once

#include <cstdint>

#include "renderer/testing/bvh_meshes.h"

namespace rtrays {

/// Builds a hall of size 12 x 8 x 36 (x, y, z) with its corner at the origin and `count` triangles.
/// It has a floor, walls and a ceiling in slight relief, two galleries on rows of columns, and
/// vases. A court has no ceiling.
test::Mesh hall(uint32_t count);
test::Mesh court(uint32_t count);

/// Builds a city of `count` triangles: houses with bay windows on a square grid with a pitch of 30.
/// No house is higher than 60.
test::Mesh city(uint32_t count);

}  // namespace rtrays
