// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "renderer/scene/stores.h"

namespace rtrays {

/// Writes one mesh of the arrays as binary PLY (Turk 1994): vertices x, y, z as they are, nx, ny,
/// nz and u, v where it has them, triangles as vertex_indices. Throws `Error` (run failed) naming
/// the file.
void write_ply(const MeshArrays &meshes, uint32_t mesh, const std::filesystem::path &path);

}  // namespace rtrays
