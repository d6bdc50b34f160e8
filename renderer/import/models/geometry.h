// SPDX-License-Identifier: MIT
// Geometry operations shared by the readers of all model formats.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/mesh.h"

namespace rtrays {

/// Appends the triangles of a face to `geometry`, which already has its vertices. Returns the
/// number of triangles. Ignores a face of fewer than three corners, and splits a self-intersecting
/// polygon into a fan, each with a note. Throws `Error` (bad input) naming the mesh and the face if
/// a vertex index is out of range.
size_t add_face(const uint32_t *corners, size_t count, size_t face, const std::string &mesh,
                MeshCore::Geometry &geometry, ModelNotes &notes);

/// Merges vertices with equal position, normal, texture coordinates and colour, and drops unused
/// ones. Triangles keep their order. Vertices are in the order of their first use.
void join_vertices(MeshCore::Geometry &geometry);

/// Sets the normal of every vertex to the mean normal of its triangles, weighted by their angles at
/// the vertex (Thuermer and Wuethrich, "Computing vertex normals from polygonal facets", 1998).
void make_smooth_normals(MeshCore::Geometry &geometry);

/// Replaces normals that are zero or not finite by smooth normals, with a note.
void repair_normals(MeshCore::Geometry &geometry, const std::string &mesh, ModelNotes &notes);

/// Clamps colours of vertices to [0, 1], with a note. Those that are not finite remain, and the
/// mesh reports them.
void clamp_colours(MeshCore::Geometry &geometry, const std::string &mesh, ModelNotes &notes);

/// Returns the number of triangles whose normals, in the mean of the corners, are on the other side
/// than the front that the winding defines.
size_t count_opposed(const MeshCore &mesh);

/// Adds a note if the normals of triangles oppose their winding. Such files may mean either side.
void note_opposed(const MeshCore &mesh, ModelNotes &notes);

/// Appends `part`, transformed. If only one of the two has normals, the other one gets the normals
/// of its triangles. If only one has texture coordinates or colours, the coordinates of the other
/// one are zero and its colours white.
void append_geometry(MeshCore::Geometry &geometry, MeshCore::Geometry part,
                     const Eigen::Matrix4d &transform);

/// Returns the triangles of each group with the vertices that they use. `groups` has the group
/// number of each triangle.
std::map<int64_t, MeshCore::Geometry> split_geometry(const MeshCore::Geometry &geometry,
                                                     const std::vector<int64_t> &groups);

}  // namespace rtrays
