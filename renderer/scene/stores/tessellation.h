// SPDX-License-Identifier: MIT
// Tessellation of quadrics to triangles, for renderers and lights that lack these shapes.
#pragma once

#include <cstdint>

#include "renderer/scene/stores.h"

namespace rtrays {

/// Numbers of cells along v and u.
struct TessellationGrid {
    uint32_t rows = 256, columns = 512;
};

/// Returns whether `tessellated` supports a kind of shape: all but planes and Julia sets.
bool can_be_tessellated(ShapeArrays::Kind kind);

/// Returns a mesh of a shape, as the only mesh of its arrays: in world space, with the normals,
/// texture coordinates and front side that stores.h defines.
///
/// The chord of a circle is below the circle by at most 1 - cos(pi / columns) of the radius, 1.9e-5
/// by default. Spheres and discs are scaled to their exact area, which leaves +- 2e-5. Throws
/// `Error` (run failed) for a kind of shape that cannot be tessellated.
MeshArrays tessellated(const ShapeArrays &shapes, uint32_t shape,
                       const TessellationGrid &grid = {});

}  // namespace rtrays
