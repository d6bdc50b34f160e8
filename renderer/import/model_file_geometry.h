// SPDX-License-Identifier: MIT
// What files of all formats need before their faces are a mesh of ours.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "renderer/import/model_file_notes.h"
#include "renderer/scene/cores/mesh.h"

namespace rtrays {

/// Appends the triangles of a face to `geometry`, whose vertices are there, and returns how many
/// they are. What has fewer than three corners is left out and a polygon that crosses itself
/// becomes a fan, both with a note. Throws `Error` (bad input) naming the mesh and the face when a
/// corner is no vertex.
size_t add_face(const uint32_t *corners, size_t count, size_t face, const std::string &mesh,
                MeshCore::Geometry &geometry, ModelNotes &notes);

/// Makes vertices one that are equal bit by bit in position, normal and texture coordinates; drops
/// those that no triangle uses. Triangles keep their order, vertices that of their first use.
void join_vertices(MeshCore::Geometry &geometry);

/// Gives every vertex the normal of its triangles, weighted by their angles there (Thuermer and
/// Wuethrich, "Computing vertex normals from polygonal facets", 1998).
void make_smooth_normals(MeshCore::Geometry &geometry);

/// Replaces normals that have no direction by such smooth ones, with a note.
void repair_normals(MeshCore::Geometry &geometry, const std::string &mesh, ModelNotes &notes);

/// Appends `part`, transformed. Where only one of the two has normals the other gets those of its
/// triangles; texture coordinates that one of them lacks are zero.
void append_geometry(MeshCore::Geometry &geometry, MeshCore::Geometry part,
                     const Eigen::Matrix4d &transform);

/// The triangles of each group, with the vertices that they use; `groups` has one number per
/// triangle.
std::map<int64_t, MeshCore::Geometry> split_geometry(const MeshCore::Geometry &geometry,
                                                     const std::vector<int64_t> &groups);

}  // namespace rtrays
