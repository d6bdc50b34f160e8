// SPDX-License-Identifier: MIT
// Writing of meshes as PLY files.
#pragma once

#include <filesystem>

#include "renderer/scene/stores.h"

namespace rtrays {

/// Writes one mesh of the arrays as binary PLY (Turk 1994): vertices x, y, z without a transform,
/// normals nx, ny, nz and coordinates u, v if the mesh has them, triangles as vertex_indices. With
/// `with_colours`, also linear colours r, g, b, white if the mesh has none. Throws `Error` (run
/// failed) naming the file.
void write_ply(const MeshArrays &meshes, uint32_t mesh, const std::filesystem::path &path,
               bool with_colours = false);

}  // namespace rtrays
