// SPDX-License-Identifier: MIT
// Loads the meshes on which hierarchies are measured, each with a view.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/testing/bvh_meshes.h"

namespace rtrays {

/// Origin and direction of the primary rays.
struct View {
    Eigen::Vector3f origin;
    Eigen::Vector3f direction;  ///< need not be normalised
    float degrees;              ///< field of view, horizontal and vertical
};

/// Returns the names of the available named meshes: procedural meshes with fixed triangle counts,
/// the Cornell box, and the models found in the folder that the environment variable RTRAYS_MESHES
/// names.
std::vector<std::string> measured_meshes();

struct MeasuredMesh {
    test::Mesh mesh;
    View view;
};

/// Loads a mesh by its name. The name is one of `measured_meshes`, a folder of scenes/ whose
/// scene.json has meshes, or a procedural mesh of N triangles: "hall_N", "court_N", "city_N"
/// (buildings.h) or "scattered_N". The last one has spheres of a few hundred to a few thousand
/// triangles on a hilly floor; their radii span two decades. Throws `Error` (bad input) listing the
/// names if the mesh does not exist, and the errors of the file readers.
MeasuredMesh load_measured_mesh(const std::string &name);

/// Returns whether `load_measured_mesh` knows the name and its files exist.
bool has_measured_mesh(const std::string &name);

/// Throws `Error` (bad input) listing the names if `load_measured_mesh` does not know the name. The
/// files of a model may be missing.
void require_mesh_name(const std::string &name);

/// Returns whether the name is that of a procedural mesh with N triangles.
bool is_procedural(const std::string &name);

/// Returns the path of a file in this repository ("scenes/...") or in the folder of models. The
/// path is empty for a model if RTRAYS_MESHES is not set.
std::filesystem::path measured_file(const std::string &file);

/// Appends the vertices and triangles of `part` to `mesh`.
void append(test::Mesh &mesh, const test::Mesh &part);

}  // namespace rtrays
