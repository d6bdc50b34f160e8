// SPDX-License-Identifier: MIT
// Command line of rtrays-render: options, their consistency, and what they mean for scene and
// settings.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/import/scene_options.h"
#include "renderer/scene/scene.h"
#include "renderer/session/settings.h"

namespace CLI {
class App;
}

namespace rtrays {

/// Options of a render.
struct Options {
    std::string scene;
    std::vector<std::string> outputs;
    double exposure = 0;
    std::string exported;
    std::string size, crop;
    std::string samples;
    std::optional<uint64_t> spp;
    std::optional<double> seconds;
    SceneOptions scene_options;
    std::string device;
    std::string state;
    std::string stats;
    std::vector<std::string> assignments;
    std::vector<std::string> layers = {"variance", "samples"};
    double checkpoint_interval = 300;  ///< seconds between films
    std::optional<double> preview;     ///< seconds between images while it renders
    bool resume = false;
    bool overwrite = false;
    bool quiet = false;
    bool dry_run = false;
    bool print_scene = false;
    bool json = false;  ///< the form of --print-scene
    bool list_devices = false;
    bool list_algorithms = false;
    std::string algorithm = algorithms::path_tracing.name;
    std::string passes = "all";
    RenderSettings settings;
};

/// Adds the options of a render to its parser, which writes them to `options`.
void add_options(CLI::App &app, Options &options);

/// Adds the options that name images to write, with the exposure of those for display.
void add_output_options(CLI::App &app, std::vector<std::string> &outputs, double &exposure);

/// Throws `Error` (bad usage) when options exclude each other, or an output cannot be written.
void require_consistent(const Options &options);

/// Throws `Error` (bad usage) unless every output can be written; `suggestion` is the name of an
/// image without its ending.
void require_outputs(const std::vector<std::string> &outputs, const std::string &suggestion);

/// Throws `Error` (bad usage) if a film would be replaced without --overwrite.
void require_new_film(const std::string &path, bool overwrite, const char *alternatives);

/// Applies --set to the scene and the settings, and the other options that are settings. The
/// sampler that --set does not name is `default_sampler`.
void apply_options(Options &options, Scene &scene);

/// Sets the size of the scene's film: --size, or that of the scene. The image is its window.
void set_size(Options &options, Scene &scene);

/// Returns the samples that the options ask for.
SampleRange requested_samples(const Options &options);

/// Returns whether a layer is among those that --layers names.
bool requested(const std::vector<std::string> &layers, const std::string &name);

/// Returns a name for an image of a scene: the folder of a scene.json, else the file's name.
std::string image_name(const std::filesystem::path &scene);

}  // namespace rtrays
