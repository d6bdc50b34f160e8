// SPDX-License-Identifier: MIT
// Loads the scenes on which full frames are timed: models and procedural meshes, each with a camera
// and lights.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace rtrays {

struct TimedScene {
    Scene scene;
    bool is_procedural;
    std::string description;  ///< surfaces and lights
};

/// Materials of a timed scene.
enum class Surfaces {
    own,     ///< the model's materials, or a Lambert and a Blinn lobe if it has none
    diffuse  ///< one Lambert material for all surfaces
};

/// Returns the names of the model scenes whose files exist, and "NAME_N" for the procedural scenes
/// with N triangles.
std::vector<std::string> timed_scenes();

/// Loads a scene by its name. The name is that of a model scene, a folder of scenes/, or a
/// procedural scene with N triangles: "court_N", "court_N_upper" (seen from a gallery), "hall_N",
/// "landscape_N" or "city_N". Throws `Error` (bad input) listing the names if the scene does not
/// exist, and the errors of the file readers.
TimedScene load_timed_scene(const std::string &name, Surfaces surfaces);

/// Returns whether `load_timed_scene` knows the name and its files exist.
bool has_timed_scene(const std::string &name);

/// Throws `Error` (bad input) listing the names if `load_timed_scene` does not know the name. The
/// files of a model may be missing.
void require_scene_name(const std::string &name);

}  // namespace rtrays
