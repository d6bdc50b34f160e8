// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/cores/mesh.h"

namespace rtrays {

/// A mesh whose vertices follow keyframes. Between two of them positions are interpolated linearly,
/// and so are normals, to be unit again; at a keyframe the mesh is that of the keyframe to the bit;
/// before the first and after the last it stays as it is there. Triangles and texture coordinates
/// are those of the first keyframe.
class MorphedMesh : public MeshCore {
  public:
    /// What the mesh is at one time.
    struct Key {
        double time;  ///< scene time, seconds
        Geometry geometry;
    };

    /// Throws `Error` (bad input) naming mesh and keyframe when there is none, times are not finite
    /// and ascending, a mesh is one that `MeshCore` refuses, or vertices, normals or triangles do
    /// not answer to those of the first keyframe.
    MorphedMesh(std::string name, std::vector<Key> keys);

    bool is_animated() const override { return true; }
    void update(double time) override;

  private:
    struct Vertices {
        double time;
        std::vector<Eigen::Vector3d> positions, normals;
    };

    std::vector<Vertices> keys_;
    double time_;  ///< that the vertices are of, held at the ends
};

}  // namespace rtrays
