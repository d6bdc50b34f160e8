// SPDX-License-Identifier: MIT
// Light of a scene that an algorithm cannot see, as notices for the user.
#pragma once

#include <string>
#include <vector>

#include "renderer/integrators/algorithm.h"
#include "renderer/scene/stores.h"

namespace rtrays {

/// Returns a sentence for each class of light paths that the scene may have and that the algorithm
/// does not see. It names the class, the lights and the algorithms that see it. A scene without
/// light is one sentence, too. `max_depth` is the maximum number of scattering events, 0: no limit.
///
/// Surfaces and lights decide whether a scene may have a class, not their positions. The list is
/// empty for algorithms without random numbers, which omit most light by definition. Nearly
/// specular surfaces are not judged.
std::vector<std::string> unseen_light(const Algorithm &algorithm, const SceneArrays &scene,
                                      uint32_t max_depth);

/// Returns the point, spot and directional lights of a scene as a list in words, empty without any.
/// No path hits them; the implicit strategy alone does not see them.
std::string lights_not_hit(const SceneArrays &scene);

}  // namespace rtrays
