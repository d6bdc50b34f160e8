// SPDX-License-Identifier: MIT
// Conversion of the materials of model files to our materials.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "renderer/import/images/texture_file.h"
#include "renderer/import/models/names.h"
#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/material.h"

struct aiMaterial;
struct aiScene;

namespace rtrays {

struct ModelSurface;

/// Converts the materials of a model file. The first matching rule applies:
///
///   1. Transmission above one half (glTF), or illum 4, 6, 7 or 9 (MTL, with index Ni and
///      transmittance Tf): glass.
///   2. Metalness and roughness (glTF): a mixture by metalness of a metal (Schlick) and a coated
///      base (Lambert below a dielectric). The distribution is GGX with alpha = roughness^2.
///   3. illum 3 or 5 (MTL) without diffuse colour: metal (Schlick) of reflectance Ks. The
///      distribution is GGX with alpha^2 = 2 / (Ns + 2).
///   4. Specular colour Ks and exponent Ns: lambert_blinn.
///   5. Otherwise: lambert.
///
/// Colours are scaled down where a material would reflect more light than it receives. With an
/// opacity below one, that fraction of the light is scattered, and the rest passes straight
/// through. Emission is radiance. Colour images are sRGB, unless they store floats.
class ModelMaterials {
  public:
    /// `model` has the embedded images. File names are relative to `directory`.
    ModelMaterials(std::shared_ptr<const aiScene> model, std::filesystem::path directory,
                   ModelNotes &notes);

    /// Converts a material and gives it this name. Throws `Error` (bad input) naming the material
    /// and the fault, for example a missing image.
    std::shared_ptr<MaterialCore> material(const aiMaterial &source, const std::string &name);

    /// Returns the textures created so far, by file and placement.
    const std::map<std::string, std::shared_ptr<Texture>> &textures() const { return textures_; }

  private:
    std::shared_ptr<const TextureImage> load(const std::string &file, bool is_colour);
    Eigen::Vector3d mean_of(const aiMaterial &source, int type, bool is_colour);
    std::shared_ptr<Texture> texture(const aiMaterial &source, int type, const std::string &name);
    ModelSurface read(const aiMaterial &source, const std::string &name);

    std::shared_ptr<const aiScene> model_;
    std::filesystem::path directory_;
    ModelNotes &notes_;
    TextureFiles files_;
    ModelNames names_;
    std::map<std::string, std::shared_ptr<const TextureImage>> embedded_;
    std::map<std::string, std::shared_ptr<Texture>> textures_;
};

/// Returns the channel of texture coordinates that a material's colour map uses.
unsigned uv_channel(const aiMaterial &source);

/// Returns the name of a material in its file, which may be empty.
std::string material_name(const aiMaterial &source);

}  // namespace rtrays
