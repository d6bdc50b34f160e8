// SPDX-License-Identifier: MIT
// Our own reader of PLY (Turk, "The PLY polygon file format", 1994): Assimp's drops the materials
// of faces and does not come to an end on some damaged files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "renderer/import/model_file_notes.h"
#include "renderer/scene/cores/mesh.h"

namespace rtrays {

struct PlyFile {
    MeshCore::Geometry geometry;
    std::vector<int64_t>
        material;  ///< per triangle: "material_index" of its face; empty when the file has none
};

/// Reads a PLY file, ASCII or binary of either byte order: vertices x, y, z, normals nx, ny, nz,
/// texture coordinates (u, v), (s, t), (texture_u, texture_v) or (texture_s, texture_t), faces
/// vertex_indices or vertex_index. Throws `Error` (bad input) naming the file and what is wrong
/// with it, before memory is taken for counts that the size of the file belies.
PlyFile read_ply(const std::filesystem::path &path, ModelNotes &notes, bool quiet);

}  // namespace rtrays
