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
    std::string environment;  ///< image file; replaces all uniform lights and images at infinity
};

/// Adds --at, --define, --environment, --fov and --look-at to the parser of a program.
void add_scene_options(CLI::App &app, SceneOptions &options);

/// Loads the scene of a file with its parameters and the environment of the options. Throws as
/// `load_scene` does, and `Error` (bad usage) for the environment.
Scene load_scene(const std::string &path, bool quiet, const SceneOptions &options);

/// Sets the property that "scene.ADDRESS=VALUE" names. Returns false if the assignment does not
/// start with "scene.". Throws `Error` (bad usage) naming the assignment.
bool set_scene_property(Scene &scene, const std::string &assignment);

/// Changes the view by the options, and updates the scene to their time. Throws `Error` (bad usage)
/// naming the option.
///
/// The camera keeps its roll: the axis of the scene file that is nearest to its upward direction
/// stays upright. Its node moves with what is on it, and is not animated any more. Points are in
/// the coordinates of the scene file.
void change_view(Scene &scene, const SceneOptions &options);

}  // namespace rtrays
