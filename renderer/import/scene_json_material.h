// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "renderer/import/scene_json_values.h"
#include "renderer/import/texture_file.h"
#include "renderer/scene/cores/material.h"

namespace rtrays {

/// A texture of the scene file. Throws `Error` (bad input) naming source, line, path and image
/// file.
std::shared_ptr<Texture> read_texture(const Json &value, const std::string &name,
                                      const SceneSource &source, const std::string &path,
                                      TextureFiles &files);

/// Finds or reads what stands where a texture may: its name or itself.
using TextureLookup = std::function<std::shared_ptr<Texture>(
    const Json &value, const std::string &name, const std::string &path)>;

/// A material of any type. Throws `Error` (bad input) naming source, line and path.
std::shared_ptr<MaterialCore> read_material(const Json &value, const std::string &name,
                                            const SceneSource &source, const std::string &path,
                                            const TextureLookup &textures);

}  // namespace rtrays
