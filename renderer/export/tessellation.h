// SPDX-License-Identifier: MIT
// Quadrics as triangles, for renderers that have no such shape.
#pragma once

#include <cstdint>

#include "renderer/scene/stores.h"

namespace rtrays {

/// Cells along v and u.
struct TessellationGrid {
    uint32_t rows = 256, columns = 512;
};

/// Whether `tessellated` makes triangles of it: of all but planes and Julia sets.
bool can_be_tessellated(ShapeArrays::Kind kind);

/// A mesh, the only one of its arrays, of that shape: in world space, with normals, texture
/// coordinates and front as stores.h states them.
///
/// Chords of a circle are at most 1 - cos(pi / columns) of its radius below it, 1.9e-5 by default;
/// spheres and discs are scaled to their area, which leaves +- 2e-5. Throws `Error` (run failed)
/// for what cannot be tessellated.
MeshArrays tessellated(const ShapeArrays &shapes, uint32_t shape,
                       const TessellationGrid &grid = {});

}  // namespace rtrays
