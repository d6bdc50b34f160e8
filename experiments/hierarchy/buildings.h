// SPDX-License-Identifier: MIT
// Procedural architecture, for models that are not there.
#pragma once

#include <cstdint>

#include "renderer/tests/bvh_meshes.h"

namespace rtrays {

/// A hall of 12 x 8 x 36 (x, y, z) from the origin on, of `count` triangles: floor, walls and
/// ceiling in slight relief, two galleries on rows of columns, and vases. A court has no ceiling.
test::Mesh hall(uint32_t count);
test::Mesh court(uint32_t count);

/// Blocks of houses with bay windows along straight streets, 30 apart, of `count` triangles; none
/// is higher than 60.
test::Mesh city(uint32_t count);

}  // namespace rtrays
