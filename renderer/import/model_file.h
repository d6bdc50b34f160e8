// SPDX-License-Identifier: MIT
// Model files: PLY by our own reader, OBJ, STL, glTF, FBX, Collada, 3DS and what else Assimp knows
// by it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Whether a file is a model file by its extension.
bool is_model_file(const std::filesystem::path &path);

struct MeshFileOptions {
    enum class Normals {
        stored,  ///< the file's, if it has any
        smooth,  ///< the file's, or else those of the triangles around each vertex, weighted by
                 ///< angle
        none,
    };
    Normals normals = Normals::stored;
    bool flip_v = false;  ///< v becomes 1 - v
    bool quiet = true;    ///< no progress
};

/// All triangles of a model file as one mesh in the coordinates of the file: placed by its nodes,
/// polygons split, materials left out. Throws `Error` (bad input) naming the file and what is wrong
/// with it.
std::shared_ptr<MeshCore> load_mesh_file(const std::filesystem::path &path, const std::string &name,
                                         const MeshFileOptions &options = {});

/// A model file as a scene, updated to time 0: its nodes with their transforms, meshes shared by
/// cores where the file shares them, materials (see model_file_material.h; those of a PLY file with
/// "material_index" are in the MTL file of the same name, by their order), lights and cameras. What
/// is left out or changed is told by notices. A model without a camera gets one that sees all of
/// it, one without light a dome of radiance 1. Throws `Error` (bad input) naming the file and what
/// is wrong with it.
Scene load_model(const std::filesystem::path &path, bool quiet);

}  // namespace rtrays
