// SPDX-License-Identifier: MIT
// Reader of the materials and textures of a scene file.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "renderer/import/images/texture_file.h"
#include "renderer/import/json/values.h"
#include "renderer/scene/cores/material.h"

namespace rtrays {

/// Reads a texture. Throws `Error` (bad input) naming source, line, path and image file.
std::shared_ptr<Texture> read_texture(const Json &value, const std::string &name,
                                      const SceneSource &source, const std::string &path,
                                      TextureFiles &files);

/// Function that returns the texture that `value` names or defines inline.
using TextureLookup = std::function<std::shared_ptr<Texture>(
    const Json &value, const std::string &name, const std::string &path)>;

/// Reads a material of any type. Throws `Error` (bad input) naming source, line and path.
std::shared_ptr<MaterialCore> read_material(const Json &value, const std::string &name,
                                            const SceneSource &source, const std::string &path,
                                            const TextureLookup &textures);

}  // namespace rtrays
