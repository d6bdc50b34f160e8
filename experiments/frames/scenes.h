// SPDX-License-Identifier: MIT
// What whole frames are timed on: models and procedural meshes, each with a camera and lights.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace rtrays {

struct TimedScene {
    Scene scene;
    bool is_procedural;
    std::string description;  ///< of surfaces and lights
};

/// Its own materials, where the model has any and else one of a Lambert and a Blinn lobe; or the
/// same Lambert everywhere.
enum class Surfaces { own, diffuse };

/// Scenes of models whose files are there (measured_meshes()), and "NAME_N" of those made of N
/// triangles.
std::vector<std::string> timed_scenes();

/// `name`: a model's scene, "court_N", "court_N_upper" (seen from a gallery), "hall_N",
/// "landscape_N" or "city_N" of N triangles, or a folder of scenes/. Throws `Error` (bad input)
/// listing the names when there is no such scene, and as the readers do.
TimedScene load_timed_scene(const std::string &name, Surfaces surfaces);

/// Whether `load_timed_scene` knows the name and its files are there.
bool has_timed_scene(const std::string &name);

}  // namespace rtrays
