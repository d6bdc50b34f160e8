// SPDX-License-Identifier: MIT
// Conversion of Assimp scenes to our scenes. A build without Assimp has the errors of
// without_assimp.cpp instead.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "renderer/import/models/names.h"
#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/node.h"
#include "renderer/scene/scene.h"

namespace rtrays {

/// Returns whether Assimp reads files with this extension, such as ".obj".
bool assimp_reads(const std::string &extension);

/// Reads all triangles of the file, transformed by its nodes.
MeshCore::Geometry read_model_geometry(const std::filesystem::path &path, ModelNotes &notes,
                                       bool quiet);

/// Adds the nodes, meshes, materials, lights and cameras of the file to an empty scene.
void read_model_scene(const std::filesystem::path &path, Scene &scene, ModelNames &names,
                      ModelNotes &notes, bool quiet);

/// Returns the material of meshes without one: grey, or of the colours of vertices if there are
/// any.
std::shared_ptr<MaterialCore> default_model_material(
    const std::string &name, const std::shared_ptr<Texture> &vertex_colours = nullptr);

/// Adds a node with a transform and visibility. Throws `Error` (bad input) if the transform is
/// not finite, affine and invertible.
Node &add_model_node(Node &parent, const std::string &name, const Eigen::Matrix4d &transform);

}  // namespace rtrays
