// SPDX-License-Identifier: MIT
// Scenes from OBJ and PLY files, with the materials of MTL files.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "renderer/import/models/names.h"
#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Adds the objects of an OBJ file to an empty scene, with the materials of its MTL files. A
/// missing MTL file is an error. A material without a definition is grey, with a note.
void read_obj_scene(const std::filesystem::path &path, Scene &scene, ModelNames &names,
                    ModelNotes &notes, bool quiet);

/// Reads all triangles of an OBJ file as one mesh. Its materials are ignored.
MeshCore::Geometry read_obj_geometry(const std::filesystem::path &path, ModelNotes &notes,
                                     bool quiet);

/// Returns the materials of an MTL file in its order, which become shared cores of the scene.
/// Throws `Error` (bad input) naming the file and the fault.
std::vector<std::shared_ptr<MaterialCore>> read_model_materials(const std::filesystem::path &path,
                                                                Scene &scene, ModelNotes &notes);

/// Adds the meshes of a PLY file to an empty scene, one per material. The "material_index" of a
/// face is the index of a material in the MTL file of the same name beside the PLY file.
void read_ply_scene(const std::filesystem::path &path, Scene &scene, ModelNames &names,
                    ModelNotes &notes, bool quiet);

}  // namespace rtrays
