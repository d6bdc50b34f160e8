// SPDX-License-Identifier: MIT
// Conversion of the materials that Assimp reads to our materials.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "renderer/import/models/gltf.h"
#include "renderer/import/models/surface.h"
#include "renderer/import/models/textures.h"

struct aiMaterial;
struct aiScene;

namespace rtrays {

/// Converts the materials of a model file to surfaces, which `make_model_material` converts. glTF
/// has metalness and roughness, with alpha = roughness^2. A full transmission is glass. Other
/// formats have a diffuse colour, and a specular colour with an exponent.
class ModelMaterials {
  public:
    /// `model` has the embedded images. File names are relative to `directory`. `extended` has the
    /// materials of a glTF file, and is empty for other formats. The name of a glTF material in
    /// `model` is its index there. If `vertex_coloured`, colours of vertices multiply base colours.
    ModelMaterials(std::shared_ptr<const aiScene> model, std::filesystem::path directory,
                   std::vector<GltfMaterial> extended, bool vertex_coloured, ModelNotes &notes);

    /// Returns the name of a material in its file, which may be empty.
    std::string name(unsigned index) const;

    /// Converts the material of that index and gives it this name. Throws `Error` (bad input)
    /// naming the material and the fault, for example a missing image.
    std::shared_ptr<MaterialCore> material(unsigned index, const std::string &name);

    /// Returns the channel of texture coordinates that the colour map of a material uses.
    unsigned uv_channel(unsigned index) const;

    /// Returns the transform of the texture coordinates of a material that a texture cannot have,
    /// because it rotates. Otherwise the identity.
    GltfTextureTransform uv_transform(unsigned index) const;

    /// Returns the textures created so far.
    const std::vector<std::shared_ptr<Texture>> &textures() const { return textures_.all(); }

  private:
    const GltfMaterial *extended(unsigned index) const;
    /// Returns whether the colours of vertices of a mesh multiply this material.
    bool is_vertex_coloured(unsigned index) const;
    /// Returns an image, or null for an alpha channel that is missing or opaque everywhere.
    std::shared_ptr<const TextureImage> load(const std::string &file, TextureEncoding encoding);
    /// Returns the mean of the map of a type, of which a material may have several, or white.
    Eigen::Vector3d mean_of_map(const aiMaterial &source, int type, bool is_colour,
                                unsigned index = 0);
    /// How a map is used.
    struct MapUse {
        TextureEncoding encoding = TextureEncoding::srgb;
        bool vertex_colours = false;  ///< the colours of vertices multiply it
        int channel = -1;             ///< the only channel that counts, or -1
    };
    /// Returns the texture of a map, or null. `transform` is that of a glTF file. Without it, the
    /// material has the placement.
    std::shared_ptr<Texture> texture(const aiMaterial &source, int type,
                                     const GltfTextureTransform *transform, const std::string &name,
                                     const MapUse &use);
    std::shared_ptr<Texture> texture(const aiMaterial &source, int type,
                                     const GltfTextureTransform *transform, const std::string &name,
                                     TextureEncoding encoding = TextureEncoding::srgb) {
        return texture(source, type, transform, name, MapUse{encoding});
    }
    /// Returns the image of one channel in all three.
    std::shared_ptr<const TextureImage> channel_of(const std::shared_ptr<const TextureImage> &image,
                                                   int channel);
    void read_opacity(const aiMaterial &source, const GltfMaterial *gltf, const std::string &name,
                      ModelSurface &surface);
    void read_normals(const aiMaterial &source, const GltfMaterial *gltf, const std::string &name,
                      ModelSurface &surface);
    void read_emission_map(const aiMaterial &source, const GltfMaterial *gltf,
                           const std::string &name, ModelSurface &surface);
    void read_physical(const aiMaterial &source, const GltfMaterial *gltf, const std::string &name,
                       ModelSurface &surface);
    void read_transmission(const aiMaterial &source, const GltfMaterial &material, bool is_gltf,
                           const std::string &name, ModelSurface &surface);
    /// Reads the clear coat and the sheen.
    void read_layers(const aiMaterial &source, const GltfMaterial &material,
                     const std::string &name, ModelSurface &surface);
    ModelSurface read(unsigned index, const std::string &name);

    std::shared_ptr<const aiScene> model_;
    std::filesystem::path directory_;
    std::vector<GltfMaterial> extended_;
    bool vertex_coloured_;
    ModelNotes &notes_;
    ModelTextures textures_;
    std::map<std::pair<std::string, TextureEncoding>, std::shared_ptr<const TextureImage>>
        embedded_;
    std::map<std::pair<const TextureImage *, int>, std::shared_ptr<const TextureImage>> channels_;
};

}  // namespace rtrays
