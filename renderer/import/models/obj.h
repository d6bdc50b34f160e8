// SPDX-License-Identifier: MIT
// Our own reader of Wavefront OBJ files. Assimp's reader loses vertices on lines with a comment,
// and its errors have no line numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/mesh.h"

namespace rtrays {

/// The triangles of one object that have one material.
struct ObjMesh {
    std::string object;    ///< name of the last `o` or `g`, may be empty
    std::string material;  ///< name of the last `usemtl`, may be empty
    MeshCore::Geometry geometry;
};

/// A statement `mtllib`.
struct ObjLibraries {
    std::string files;  ///< one name or several
    size_t line = 0;
};

/// The contents of an OBJ file.
struct ObjFile {
    std::vector<ObjMesh> meshes;  ///< in the order of first appearance
    std::vector<ObjLibraries> libraries;
};

/// Reads an OBJ file: vertices, their colours (x y z r g b, decoded by the sRGB curve), normals,
/// texture coordinates, polygons, objects, groups and names of materials. Lines may have comments
/// and blanks, and may continue after a backslash. Notes report all other statements. Throws
/// `Error` (bad input) naming the file, the line and the fault if a statement is malformed, an
/// index is out of range or the file has no faces.
ObjFile read_obj(const std::filesystem::path &path, ModelNotes &notes, bool quiet);

}  // namespace rtrays
