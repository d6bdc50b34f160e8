// SPDX-License-Identifier: MIT
// The meshes that hierarchies are measured on, each with a place to look from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/tests/bvh_meshes.h"

namespace rtrays {

/// From where primary rays start, and whereto.
struct View {
    Eigen::Vector3f origin;
    Eigen::Vector3f direction;  ///< of any length
    float degrees;              ///< field of view, both ways
};

/// Procedural meshes of stated triangle counts, the Cornell box, and those models of the folder
/// $RTRAYS_MESHES that are there (../shared/meshes of a checkout unless it is set).
std::vector<std::string> measured_meshes();

struct MeasuredMesh {
    test::Mesh mesh;
    View view;
};

/// `name`: one of measured_meshes(), a folder of scenes/ with meshes in its scene.json, or a
/// procedural mesh of N triangles: "hall_N", "court_N", "city_N" (buildings.h), or "scattered_N":
/// spheres of a few hundred to a few thousand triangles, their sizes over two decades, on a hilly
/// floor. Throws `Error` (bad input) listing the names when there is no such mesh, and as the
/// readers do.
MeasuredMesh load_measured_mesh(const std::string &name);

/// Whether `load_measured_mesh` knows the name and its file is there.
bool has_measured_mesh(const std::string &name);

/// Whether the name is that of a procedural mesh.
bool is_procedural(const std::string &name);

/// The path of a file of the models' folder, or of this repository ("scenes/...").
std::filesystem::path measured_file(const std::string &file);

/// Adds the triangles of `part` to `mesh`, with vertices of their own.
void append(test::Mesh &mesh, const test::Mesh &part);

}  // namespace rtrays
