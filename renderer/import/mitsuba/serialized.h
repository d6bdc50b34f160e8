// SPDX-License-Identifier: MIT
// Reader of Mitsuba's meshes in files of the type .serialized.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/mesh.h"

namespace rtrays::mitsuba {

/// Returns mesh `index` of the bytes of a file, versions 3 and 4 (Mitsuba 3.9,
/// src/shapes/serialized.cpp). Its normals, texture coordinates and triangles are those stored;
/// colours are ignored with a note. Throws `Error` (bad input) naming `name` and the byte of the
/// file.
MeshCore::Geometry parse_serialized(const std::string &bytes, size_t index, const std::string &name,
                                    ModelNotes &notes);

/// As `parse_serialized`, for a file. Its notes are sent as notices.
MeshCore::Geometry read_serialized(const std::filesystem::path &path, size_t index);

}  // namespace rtrays::mitsuba
