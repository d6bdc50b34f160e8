// SPDX-License-Identifier: MIT
// Reader of model files. PLY and OBJ files are read by our own readers. STL, glTF, FBX, Collada,
// 3DS and all other formats are read through Assimp.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Returns whether the extension is that of a model file.
bool is_model_file(const std::filesystem::path &path);

/// Options of `load_mesh_file`.
struct MeshFileOptions {
    /// Source of the shading normals.
    enum class Normals {
        stored,  ///< normals of the file, if it has any
        smooth,  ///< normals of the file, or means of face normals weighted by angle
        none,    ///< no shading normals
    };
    Normals normals = Normals::stored;
    bool flip_v = false;  ///< replace v by 1 - v
    bool quiet = true;    ///< do not show progress
};

/// Reads all triangles of a model file as one mesh, in the coordinates of the file. Node transforms
/// are applied, polygons are split and materials are ignored. Throws `Error` (bad input) naming the
/// file and the fault.
std::shared_ptr<MeshCore> load_mesh_file(const std::filesystem::path &path, const std::string &name,
                                         const MeshFileOptions &options = {});

/// Reads a model file as a scene and updates it to time 0. The scene has the nodes of the file with
/// their transforms, and its meshes, materials, lights and cameras. Meshes that the file shares are
/// shared cores. Materials are converted as described in surface.h. The
/// "material_index" of a PLY file is the index of a material in the MTL file of the same name.
/// Notices report everything ignored or changed. Unless it is part of another scene, a camera that
/// sees the full model is added if the file has none, and a dome of radiance 1 if it has no light.
/// Throws `Error` (bad input) naming the file and the fault.
Scene load_model(const std::filesystem::path &path, bool quiet, bool is_part = false);

}  // namespace rtrays
