// SPDX-License-Identifier: MIT
// What Assimp 5.2.5 loses of a glTF file: extensions, and whether the file requires them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "renderer/base/json.h"
#include "renderer/import/models/notes.h"

namespace rtrays {

/// A texture transform (KHR_texture_transform) in our texture coordinates, whose v points up:
/// `linear * uv + offset`.
struct GltfTextureTransform {
    Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();

    bool rotates() const { return linear(0, 1) != 0 || linear(1, 0) != 0; }
};

/// The texture coordinates of a map.
struct GltfPlacement {
    unsigned uv_set = 0;
    GltfTextureTransform transform;
};

/// The properties of a material that Assimp loses, with the defaults of glTF.
struct GltfMaterial {
    std::string name;
    double emissive_strength = 1;
    double ior = 1.5;
    double transmission = 0;
    double thickness = 0;
    double attenuation_distance = std::numeric_limits<double>::infinity();
    Eigen::Vector3d attenuation_colour = Eigen::Vector3d::Ones();
    double clearcoat = 0;
    double clearcoat_roughness = 0;
    Eigen::Vector3d sheen_colour = Eigen::Vector3d::Zero();
    double specular = 1;
    Eigen::Vector3d specular_colour = Eigen::Vector3d::Ones();
    bool is_two_sided = false;
    unsigned base_uv_set = 0;  ///< texture coordinates of the base colour
    GltfTextureTransform base_transform;
    double normal_scale = 1;
    /// Whether the map of normals uses the texture coordinates of the base colour, and neither
    /// rotates them.
    bool normals_use_base_uv = true;
    GltfTextureTransform normal_transform;
    GltfPlacement emission;
    GltfPlacement roughness;
    GltfPlacement transmission_map;
    GltfPlacement sheen_map;
};

/// A .gltf or .glb file.
struct GltfFile {
    Json document;
    std::string head;    ///< of a .glb file: the bytes before the JSON, with their sizes
    std::string chunks;  ///< of a .glb file: what follows the JSON
};

/// Reads a .gltf or .glb file. Throws `Error` (bad input) naming the file if it is damaged.
GltfFile read_gltf(const std::filesystem::path &path);

/// Returns the file in a form that Assimp 5.2.5 reads without losses. Materials and nodes have
/// their index as a name: Assimp numbers materials in the order in which meshes use them, and finds
/// the node of a light or a camera by its name. Each node has its own light and camera, because
/// Assimp keeps one node of a shared one. Percent-encoded file names are decoded.
std::string for_assimp(GltfFile file);

/// Returns the names of the nodes of a glTF document. A node without a name has an empty one.
std::vector<std::string> gltf_node_names(const Json &document);

/// Checks a glTF document. Notes name the extensions that are used and ignored, and what Assimp
/// drops without a word. Throws `Error` (bad input) naming a required extension that is
/// unsupported, or attributes that are not floats.
void check_gltf(const Json &document, const std::filesystem::path &path, ModelNotes &notes);

/// Returns the extended properties of the materials of a glTF document, in its order. Throws
/// `Error` (bad input) naming the material if a property has a wrong type.
std::vector<GltfMaterial> gltf_materials(const Json &document, ModelNotes &notes);

}  // namespace rtrays
