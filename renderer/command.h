// SPDX-License-Identifier: MIT
// What the programs that render a scene share around the render itself: the command line, the
// scene, the session, the film to continue, and the results.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/device/context.h"
#include "renderer/options.h"
#include "renderer/session/render_session.h"

namespace CLI {
class App;
}

namespace rtrays {

/// Parses the arguments. Returns the exit code if the program ends then, after --help for instance.
std::optional<ExitCode> parse(CLI::App &app, int argc, char **argv);

/// Parses the command line of a render by `program`, whose help begins with `description`. Lists
/// devices or algorithms if it asks for them. Returns the exit code if the program ends then.
/// Throws `Error` (bad usage) without a scene.
std::optional<ExitCode> parse_render(const std::string &program, const std::string &description,
                                     int argc, char **argv, Options &options);

/// Loads the scene with the changes of the options, and applies the options to the settings. Prints
/// or exports the scene if they ask for it, and then returns nothing.
std::optional<Scene> load_scene(Options &options);

/// Creates a session for the scene at the time of --at. A hierarchy that is refitted is first built
/// at time 0.
RenderSession make_session(Scene &scene, const Options &options, DeviceContext &device);

/// Prints notices of light that the algorithm does not see with its settings.
void notice_unseen_light(const Scene &scene, const RenderSettings &settings);

/// Continues with the film of --state, if --resume is given and the file exists. Returns the
/// samples that are missing. With --time they begin after the film and have no end.
SampleRanges resume(RenderSession &session, const Options &options);

/// Writes an image to all outputs.
void write_images(const Image &image, const std::vector<std::string> &outputs, double exposure);

/// Saves the film in the file of --state, if there is one. If that fails, keeps it in another file,
/// which the error names.
void save_state(const FilmState &film, const Options &options);

/// Writes the images with the requested layers, while the render continues. A failure is a notice.
void write_preview(const RenderSession &session, const FilmState &film, const Options &options);

/// Writes the images with the requested layers. If that fails, keeps the film in a file that the
/// error names.
void write_results(const RenderSession &session, const FilmState &film, const Options &options);

/// Prints what was written, how long it took in seconds, and the rate. `samples` are those of all
/// pixels.
void print_summary(const Options &options, uint64_t samples, double seconds);

/// Prints that the render was interrupted, and how to continue.
void print_interruption(const Options &options);

}  // namespace rtrays
