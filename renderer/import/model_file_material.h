// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "renderer/import/model_file_names.h"
#include "renderer/import/model_file_notes.h"
#include "renderer/import/texture_file.h"
#include "renderer/scene/cores/material.h"

struct aiMaterial;
struct aiScene;

namespace rtrays {

struct ModelSurface;

/// Turns the materials of a model file into ours, the first row that holds:
///
///   metalness and roughness (glTF)         transmission above a half: glass. Else a metal
///   (Schlick) and, under a
///                                          dielectric coat, Lambert, mixed by metalness; alpha =
///                                          roughness^2, GGX
///   illum 4, 6, 7, 9 (MTL)                 glass of Ni and Tf
///   illum 3, 5 without diffuse colour      metal (Schlick) of reflectance Ks; alpha^2 = 2 / (Ns +
///   2), GGX specular colour Ks and exponent Ns     lambert_blinn, scaled where it would reflect
///   more than it receives any                                    lambert
///
/// An opacity below one lets that share of the light be scattered and the rest pass straight on.
/// What is emitted is radiance. Images of colours are sRGB, unless they hold floats.
class ModelMaterials {
  public:
    /// `model` holds the embedded images; files are relative to `directory`.
    ModelMaterials(std::shared_ptr<const aiScene> model, std::filesystem::path directory,
                   ModelNotes &notes);

    /// The material, with the name given. Throws `Error` (bad input) naming the material and what
    /// is wrong with it, an image that is missing among them.
    std::shared_ptr<MaterialCore> material(const aiMaterial &source, const std::string &name);

    /// The textures made so far, by file and placement.
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

/// The channel of texture coordinates that a material's colour is looked up by.
unsigned uv_channel(const aiMaterial &source);

/// The name of a material in its file; may be empty.
std::string material_name(const aiMaterial &source);

}  // namespace rtrays
