// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "renderer/import/scene_json_values.h"
#include "renderer/scene/cores/transform.h"

namespace rtrays {

/// The "transform" or the "animation" of a node, the identity when it has neither. Throws `Error`
/// (bad input) naming source, line and path.
std::shared_ptr<TransformCore> read_transform(const Json &node, const std::string &name,
                                              const SceneSource &source, const std::string &path);

}  // namespace rtrays
