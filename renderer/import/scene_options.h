// SPDX-License-Identifier: MIT
// Command-line options that change a loaded scene: the view of its camera, its environment and its
// properties. All programs that load one scene have them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace CLI {
class App;
}

namespace rtrays {

/// Changes of a scene.
struct SceneOptions {
    std::vector<std::string> defines;  ///< NAME=VALUE, parameters of a Mitsuba scene
    double time = 0;                   ///< scene time, seconds
    std::vector<std::string> look_at;  ///< eye and target "X,Y,Z"; empty: the scene's view
    std::optional<double> fov;         ///< degrees; nothing: the scene's
    std::string environment;           ///< image file; empty: the scene's
};

/// Adds --at, --define, --environment, --fov and --look-at to the parser of a program.
void add_scene_options(CLI::App &app, SceneOptions &options);

/// Sets the property that "scene.ADDRESS=VALUE" names. Returns false if the assignment does not
/// start with "scene.". Throws `Error` (bad usage) naming the assignment.
bool set_scene_property(Scene &scene, const std::string &assignment);

/// Changes a scene by all options but `defines`, and updates it to their time. Throws `Error` (bad
/// usage) naming the option.
///
/// * The environment replaces all lights at infinity that have an image or are uniform.
/// * The camera keeps its roll: the axis of the scene file that is nearest to its upward direction
///   stays upright. Its node moves with what is on it, and is not animated any more. Points are in
///   the coordinates of the scene file.
void change_scene(Scene &scene, const SceneOptions &options);

}  // namespace rtrays
