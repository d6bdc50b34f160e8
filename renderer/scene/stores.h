// SPDX-License-Identifier: MIT
// What the scene graph serializes into (thesis 3.2): one store per serializable type, structure of arrays,
// world space. The renderer's scene compiler and the Embree reference both read these, and only these.
//
// After `Scene::update` the arrays are compact: every record is live, every index valid, every light has a
// positive area. Indices of records may change when something is hidden or removed, never otherwise.
//
// World space is that of the scene file, moved by `Scene::origin` (zero for all but scenes far away from
// their own origin), so that rounding to float costs nothing that matters.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace rtrays {

using Rgb = Eigen::Vector3f;               ///< linear Rec. 709
using Triangle = std::array<uint32_t, 3>;  ///< vertex indices, counter-clockwise seen from the front

constexpr uint32_t no_index = 0xffffffffu;

/// Perspective cameras. Camera space: looking along -z, +y up, +x right.
struct CameraArrays {
    enum class FovAxis { x, y, smaller, larger };
    std::vector<std::string> name;                   ///< of the node
    std::vector<Eigen::Matrix4d> world_from_camera;  ///< rigid
    std::vector<double> fov;                         ///< full angle in radians along `fov_axis`
    std::vector<FovAxis> fov_axis;
};

/// Materials: for now all are Lambert reflectors, two-sided.
struct MaterialArrays {
    enum class Kind { lambert };
    std::vector<std::string> name;
    std::vector<Kind> kind;
    std::vector<Rgb> reflectance;  ///< albedo in [0, 1]
};

/// Triangle meshes, baked to world space (transform in double, then rounded to float once). Triangles and
/// vertices of a mesh are contiguous, meshes in order. A mirroring transform does not turn the front inside:
/// the order of vertices is reversed with it.
struct MeshArrays {
    // per mesh
    std::vector<std::string> name;  ///< of the node
    std::vector<uint32_t> first_triangle;
    std::vector<uint32_t> triangle_count;
    std::vector<uint32_t> first_vertex;
    std::vector<uint32_t> vertex_count;
    std::vector<uint32_t> material;  ///< index into MaterialArrays
    std::vector<uint32_t> light;     ///< index into LightArrays, `no_index` when it does not emit
    // per vertex and per triangle, all meshes in one
    std::vector<Eigen::Vector3f> position;
    std::vector<Triangle> triangle;       ///< indices into `position`
    std::vector<uint32_t> triangle_mesh;  ///< mesh of each triangle
};

/// Lights: for now diffuse area lights, one-sided (front of a mesh).
struct LightArrays {
    enum class Kind { diffuse_area };
    std::vector<std::string> name;  ///< of the node
    std::vector<Kind> kind;
    std::vector<Rgb> radiance;   ///< W / (sr m^2), leaving the front side; may be zero
    std::vector<uint32_t> mesh;  ///< index into MeshArrays
    std::vector<double> area;    ///< area of that mesh as baked, above zero
};

}  // namespace rtrays
