// SPDX-License-Identifier: MIT
// Reader of the transforms and animations of a scene file.
#pragma once

#include <memory>
#include <string>

#include "renderer/import/json/values.h"
#include "renderer/scene/cores/transform.h"

namespace rtrays {

/// Reads the "transform" or the "animation" of a node, or returns the identity if it has neither.
/// Throws `Error` (bad input) naming source, line and path.
std::shared_ptr<TransformCore> read_transform(const Json &node, const std::string &name,
                                              const SceneSource &source, const std::string &path);

}  // namespace rtrays
