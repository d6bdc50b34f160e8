// SPDX-License-Identifier: MIT
// Images and textures of model files.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/import/images/texture_file.h"
#include "renderer/import/models/names.h"
#include "renderer/import/models/notes.h"
#include "renderer/scene/cores/texture.h"

namespace rtrays {

class MaterialCore;

/// Position of an image on the (u, v) plane.
struct TexturePlacement {
    Eigen::Vector2d scale = Eigen::Vector2d::Ones();
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< added to the scaled coordinates
    TextureArrays::Wrap wrap = TextureArrays::Wrap::repeat;
    bool is_nearest = false;      ///< without interpolation
    bool vertex_colours = false;  ///< the colours of vertices multiply the image
};

/// Returns the file of that name in the first of the folders that has it. In each folder the path
/// is tried as stated, then its last part alone. Backslashes are separators. If only the case of
/// letters differs, the file is used with a note. Returns the stated path in the first folder if
/// there is no such file.
std::filesystem::path find_model_file(const std::string &stated,
                                      const std::vector<std::filesystem::path> &folders,
                                      ModelNotes &notes);

/// Returns the image, or nullptr if all of its texels are 1.
std::shared_ptr<const TextureImage> unless_opaque(std::shared_ptr<const TextureImage> alpha);

/// Returns whether a texture of the material depends on the texture coordinates of meshes.
bool needs_coordinates(const MaterialCore &material);

/// Returns the mean of the decoded texels.
Eigen::Vector3d mean_of(const TextureImage &image);

/// The images and textures of a model. Each file is loaded once, and equal placements of an image
/// share one texture.
class ModelTextures {
  public:
    explicit ModelTextures(ModelNotes &notes) : notes_(notes) {}

    /// Loads an image file, found by `find_model_file`. Colours are sRGB unless the file stores
    /// floats. Throws `Error` (bad input) naming the file.
    std::shared_ptr<const TextureImage> load(const std::string &stated,
                                             const std::vector<std::filesystem::path> &folders,
                                             bool is_colour);

    /// Returns the alpha channel of an image file, found by `find_model_file`, as a grey image.
    /// Returns nullptr if it has none or is opaque everywhere. Throws `Error` (bad input) naming
    /// the file.
    std::shared_ptr<const TextureImage> load_alpha(
        const std::string &stated, const std::vector<std::filesystem::path> &folders);

    /// Returns the texture of an image at a placement. `file` is its name in the model file.
    std::shared_ptr<Texture> texture(const std::shared_ptr<const TextureImage> &image,
                                     const std::string &file, const TexturePlacement &placement);

    /// Returns the texture of nothing but the colours of vertices.
    std::shared_ptr<Texture> vertex_colours();

    /// Returns the textures created so far.
    const std::vector<std::shared_ptr<Texture>> &all() const { return all_; }

  private:
    ModelNotes &notes_;
    TextureFiles files_;
    ModelNames names_;
    std::map<std::string, std::shared_ptr<Texture>> textures_;  ///< by image and placement
    std::vector<std::shared_ptr<Texture>> all_;                 ///< in the order of creation
};

}  // namespace rtrays
