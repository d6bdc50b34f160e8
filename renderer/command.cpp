// SPDX-License-Identifier: MIT
#include "renderer/command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>

#include "renderer/base/commit.h"
#include "renderer/base/notice.h"
#include "renderer/base/progress.h"
#include "renderer/export/display_image.h"
#include "renderer/export/export_scene.h"
#include "renderer/import/load_scene.h"
#include "renderer/integrators/unseen_light.h"

namespace rtrays {

namespace {

void print_devices() {
    for (const DeviceInfo &info : list_devices()) {
        fmt::print("{}  ({}, driver {}, {} compute units, {:.1f} GiB)\n", info.name,
                   info.platform_name, info.driver, info.compute_units,
                   static_cast<double>(info.global_memory) / 0x1p30);
    }
}

/// Returns the colours and the requested layers.
Image select_layers(const Image &image, const std::vector<std::string> &layers) {
    Image selected(image.width(), image.height());
    selected.attributes() = image.attributes();
    for (const Image::Channel &channel : image.channels()) {
        const std::string layer = channel.name.substr(0, channel.name.find('.'));
        const bool colour = channel.name == "R" || channel.name == "G" || channel.name == "B";
        // All layers but these two are images of passes or strategies.
        const bool statistics = layer == "variance" || layer == "samples";
        if (colour ||
            (statistics ? requested(layers, layer)
                        : requested(layers, "passes") || requested(layers, "strategies"))) {
            selected.add_channel(channel.name) = channel.values;
        }
    }
    return selected;
}

/// Saves the film of a render whose results cannot be written, in the file of --state or else in
/// the folder for temporary files. Returns a sentence that names the file.
std::string keep_film(const FilmState &film, const Options &options) {
    const std::string name = fmt::format("rtrays-{}-{}.film", image_name(options.scene), getpid());
    std::error_code none;
    const std::filesystem::path temporary = std::filesystem::temp_directory_path(none) / name;
    std::string reasons;
    for (const std::string &path : {options.state, temporary.string()}) {
        if (path.empty()) {
            continue;
        }
        try {
            save_film(film, path);
            return fmt::format(
                "the samples are kept in {0}; write the image with: rtrays-render merge {0} -o "
                "FILE",
                path);
        } catch (const Error &error) {
            reasons += std::string(" ") + error.what();
        }
    }
    return "the samples are lost:" + reasons;
}

/// Writes results of a render. If that fails, keeps the film in a file that the error names.
void write_or_keep(const FilmState &film, const Options &options,
                   const std::function<void()> &write) {
    try {
        write();
    } catch (const Error &error) {
        throw Error(error.exit_code(),
                    fmt::format("{}\n{}", error.what(), keep_film(film, options)));
    }
}

}  // namespace

std::optional<ExitCode> parse(CLI::App &app, int argc, char **argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError &error) {
        return app.exit(error) == 0 ? ExitCode::ok : ExitCode::bad_input;
    }
    return std::nullopt;
}

std::optional<ExitCode> parse_render(const std::string &program, const std::string &description,
                                     int argc, char **argv, Options &options) {
    CLI::App app(description, program);
    app.set_version_flag("--version", program_version(program));
    RenderSettings defaults;
    defaults.sampler = default_sampler(*defaults.algorithm);
    app.footer("Settings (--set NAME=VALUE) and their defaults:\n" + describe_settings(defaults) +
               "  scene.NODE.PROPERTY = ...  any property that --print-scene lists");
    add_options(app, options);
    if (const std::optional<ExitCode> ended = parse(app, argc, argv)) {
        return ended;
    }
    if (options.list_devices) {
        print_devices();
        return ExitCode::ok;
    }
    if (options.list_algorithms) {
        for (const std::string &name : algorithm_names()) {
            fmt::print("{}\n", name);
        }
        return ExitCode::ok;
    }
    if (options.scene.empty()) {
        throw input_error("SCENE is missing; see --help");
    }
    return std::nullopt;
}

std::optional<Scene> load_scene(Options &options) {
    Scene scene = load_scene(options.scene, options.quiet, options.scene_options);
    apply_options(options, scene);
    change_view(scene, options.scene_options);
    if (options.print_scene) {
        fmt::print("{}", options.json ? scene.describe_json() : scene.describe());
        return std::nullopt;
    }
    set_size(options, scene);
    if (!options.exported.empty()) {
        export_scene(scene, options.exported,
                     {options.spp.value_or(64), options.settings.max_depth});
        return std::nullopt;
    }
    return scene;
}

RenderSession make_session(Scene &scene, const Options &options, DeviceContext &device) {
    const bool refits = options.settings.bvh_update == BvhUpdate::refit;
    if (refits) {
        scene.update(0);
    }
    // Nothing is lost yet, and the driver's compiler does not return for seconds.
    const InterruptsEndAtOnce at_once;
    const Waiting waiting("compiling kernels and building the hierarchy", options.quiet);
    RenderSession session(scene, options.settings, device);
    if (refits) {
        scene.update(options.scene_options.time);
        session.update(scene);
    }
    return session;
}

void notice_unseen_light(const Scene &scene, const RenderSettings &settings) {
    // Without light paths, such an algorithm is path tracing.
    const Algorithm &algorithm =
        settings.algorithm->traces_light_paths() && !has_light_pass(settings)
            ? algorithms::path_tracing
            : *settings.algorithm;
    for (const std::string &sentence :
         unseen_light(algorithm, scene.arrays(), settings.max_depth)) {
        notice(sentence);
    }
    const std::string lights = lights_not_hit(scene.arrays());
    if (settings.strategies == PathStrategies::implicit_only && !lights.empty()) {
        notice("integrator.strategies=implicit: camera paths do not hit " + lights + "; use mis");
    }
}

SampleRanges resume(RenderSession &session, const Options &options) {
    SampleRange wanted = requested_samples(options);
    SampleRanges present;
    if (options.resume && std::filesystem::exists(options.state)) {
        const FilmState film = load_film(options.state);
        session.restore(film);
        present = film.ranges;
    }
    if (options.seconds) {
        wanted = {present.empty() ? 0 : present.back().end, std::numeric_limits<uint64_t>::max()};
    }
    return missing_ranges(present, wanted);
}

void write_images(const Image &image, const std::vector<std::string> &outputs, double exposure) {
    for (const std::string &path : outputs) {
        write_image(image, path, exposure);
    }
}

void save_state(const FilmState &film, const Options &options) {
    if (!options.state.empty()) {
        write_or_keep(film, options, [&] { save_film(film, options.state); });
    }
}

void write_preview(const RenderSession &session, const FilmState &film, const Options &options) {
    try {
        write_images(select_layers(session.develop(film), options.layers), options.outputs,
                     options.exposure);
    } catch (const Error &error) {
        notice(fmt::format("no preview: {}", error.what()));
    }
}

void write_results(const RenderSession &session, const FilmState &film, const Options &options) {
    const Waiting waiting("writing the image", options.quiet);
    const Image image = select_layers(session.develop(film), options.layers);
    write_or_keep(film, options, [&] { write_images(image, options.outputs, options.exposure); });
}

void print_summary(const Options &options, uint64_t samples, double seconds) {
    for (const std::string &path : options.outputs) {
        fmt::print(stderr, "wrote {} ({} x {})\n", path, options.settings.width,
                   options.settings.height);
    }
    fmt::print(stderr, "rendered in {:.1f} s, {:.3g} million samples per second\n", seconds,
               static_cast<double>(samples) / std::max(seconds, 1e-9) / 1e6);
}

void print_interruption(const Options &options) {
    fmt::print(stderr, "interrupted{}\n",
               options.state.empty() ? "; the samples are lost (--state FILM keeps what is done)"
                                     : "; continue with --resume --state " + options.state);
}

}  // namespace rtrays
