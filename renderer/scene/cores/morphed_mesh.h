// SPDX-License-Identifier: MIT
// Meshes animated by keyframes.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/cores/mesh.h"

namespace rtrays {

/// A mesh whose vertices follow keyframes. Between two keyframes positions and normals are
/// interpolated linearly, and normals are normalised again. At a keyframe the mesh is bitwise equal
/// to that of the keyframe. Before the first and after the last keyframe it is constant. Triangles
/// and texture coordinates are those of the first keyframe.
class MorphedMesh : public MeshCore {
  public:
    /// The mesh at one time.
    struct Key {
        double time;  ///< scene time, seconds
        Geometry geometry;
    };

    /// Throws `Error` (bad input) naming mesh and keyframe if there are no keyframes, times are not
    /// finite and ascending, or `MeshCore` rejects a mesh. Also throws if the triangles, or the
    /// numbers of vertices or normals, differ from those of the first keyframe.
    MorphedMesh(std::string name, std::vector<Key> keys);

    bool is_animated() const override { return true; }
    void update(double time) override;

  private:
    struct Vertices {
        double time;
        std::vector<Eigen::Vector3d> positions, normals;
    };

    std::vector<Vertices> keys_;
    double time_;  ///< time of the current vertices, clamped to the keyframes
};

}  // namespace rtrays
