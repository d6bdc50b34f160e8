// SPDX-License-Identifier: MIT
// Our own reader of PLY files (Turk, "The PLY polygon file format", 1994). Assimp's reader drops
// the materials of faces and does not terminate on some damaged files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/mesh.h"

namespace rtrays {

/// The contents of a PLY file.
struct PlyFile {
    MeshCore::Geometry geometry;
    /// "material_index" of each triangle's face, or empty if the file has none.
    std::vector<int64_t> material;
};

/// Reads a PLY file in ASCII or in binary of either byte order. Reads vertices x, y, z, normals nx,
/// ny, nz, and faces vertex_indices or vertex_index. Texture coordinates may be named (u, v),
/// (s, t), (texture_u, texture_v) or (texture_s, texture_t). Colours are (red, green, blue) or
/// (r, g, b): linear if they are floats; uchar and ushort are decoded by the sRGB curve. Throws
/// `Error` (bad input) naming the file and the fault. Counts that exceed the size of the file are
/// rejected before memory is allocated for them. Bytes after the last element are an error.
PlyFile read_ply(const std::filesystem::path &path, ModelNotes &notes, bool quiet);

}  // namespace rtrays
