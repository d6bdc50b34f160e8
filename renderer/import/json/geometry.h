// SPDX-License-Identifier: MIT
// Reader of the geometries of a scene file.
#pragma once

#include <memory>
#include <string>

#include "renderer/import/json/values.h"
#include "renderer/scene/core.h"

namespace rtrays {

/// Reads geometry of any type, either a mesh or a shape. Throws `Error` (bad input) naming source,
/// line and path.
std::shared_ptr<Core> read_geometry(const Json &value, const std::string &name,
                                    const SceneSource &source, const std::string &path);

}  // namespace rtrays
