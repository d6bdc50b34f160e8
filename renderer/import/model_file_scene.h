// SPDX-License-Identifier: MIT
// From what Assimp reads to what a scene consists of. A build without Assimp has only the errors of
// model_file_without_assimp.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "renderer/import/model_file_names.h"
#include "renderer/import/model_file_notes.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/node.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Whether Assimp has a reader of files with this extension (".obj").
bool assimp_reads(const std::string &extension);

/// All triangles of the file, placed by its nodes.
MeshCore::Geometry read_model_geometry(const std::filesystem::path &path, ModelNotes &notes,
                                       bool quiet);

/// Adds the nodes, meshes, materials, lights and cameras of the file to an empty scene.
void read_model_scene(const std::filesystem::path &path, Scene &scene, ModelNames &names,
                      ModelNotes &notes, bool quiet);

/// The materials of an MTL file, in its order, shared by the scene.
std::vector<std::shared_ptr<MaterialCore>> read_model_materials(const std::filesystem::path &path,
                                                                Scene &scene, ModelNotes &notes);

/// The material of what has none: grey.
std::shared_ptr<MaterialCore> default_model_material();

/// Adds a node with its transform and visibility; throws `Error` (bad input) as `TransformCore`.
Node &add_model_node(Node &parent, const std::string &name, const Eigen::Matrix4d &transform);

}  // namespace rtrays
