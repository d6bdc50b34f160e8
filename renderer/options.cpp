// SPDX-License-Identifier: MIT
#include "renderer/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/option_checks.h"
#include "renderer/export/display_image.h"
#include "renderer/export/export_scene.h"

namespace rtrays {

namespace {

/// Parses "AxB" or "A:B" as two numbers; throws `Error` (bad usage).
std::pair<uint64_t, uint64_t> parse_pair(const std::string &text, char separator,
                                         const char *option) {
    uint64_t first = 0, second = 0;
    const char *begin = text.data();
    const char *end = begin + text.size();
    const auto one = std::from_chars(begin, end, first);
    const bool separated = one.ec == std::errc() && one.ptr != end && *one.ptr == separator;
    const auto two = separated ? std::from_chars(one.ptr + 1, end, second) : one;
    if (!separated || two.ec != std::errc() || two.ptr != end) {
        throw input_error(fmt::format("{} '{}': expected two numbers separated by '{}'", option,
                                      text, separator));
    }
    return {first, second};
}

/// Sets the window of the picture to render: --crop, or that of the scene's film.
void set_crop(const Options &options, Scene &scene) {
    if (options.crop == "none") {
        scene.set_film_size(scene.film_width(), scene.film_height());
    } else if (!options.crop.empty()) {
        const size_t last = options.crop.rfind(',');
        const auto begin = parse_pair(options.crop.substr(0, last), ',', "--crop");
        const auto size = parse_pair(options.crop.substr(last + 1), 'x', "--crop");
        const auto side = [](uint64_t value) {
            return static_cast<int>(std::min<uint64_t>(value, 1 << 16));
        };
        scene.set_crop(
            {side(begin.first), side(begin.second), side(size.first), side(size.second)});
    }
}

}  // namespace

bool requested(const std::vector<std::string> &layers, const std::string &name) {
    return std::find(layers.begin(), layers.end(), name) != layers.end();
}

void require_outputs(const std::vector<std::string> &outputs, const std::string &suggestion) {
    if (outputs.empty()) {
        throw input_error(fmt::format(
            "no output; add -o {0}.png (for display) or -o {0}.exr (linear, with layers), or both",
            suggestion));
    }
    for (const std::string &path : outputs) {
        require_image_output(path);
    }
}

void require_new_film(const std::string &path, bool overwrite, const char *alternatives) {
    if (!path.empty() && !overwrite && std::filesystem::exists(path)) {
        throw input_error(fmt::format("--state {}: the file exists; {}", path, alternatives));
    }
}

std::string image_name(const std::filesystem::path &scene) {
    const std::string folder = scene.parent_path().filename().string();
    return scene.filename() == "scene.json" && !folder.empty() ? folder : scene.stem().string();
}

void require_consistent(const Options &options) {
    if (options.state.empty() && options.resume) {
        throw input_error("--resume needs --state FILM, the file to resume from");
    }
    if (options.resume && options.overwrite) {
        throw input_error("--resume excludes --overwrite");
    }
    if (!options.resume) {
        require_new_film(options.state, options.overwrite,
                         "--resume continues it, --overwrite replaces it");
    }
    if (options.seconds && (options.spp || !options.samples.empty())) {
        throw input_error("--time excludes --spp and --samples");
    }
    if (options.spp && !options.samples.empty()) {
        throw input_error("--spp excludes --samples");
    }
    if (!options.exported.empty()) {
        require_export_name(options.exported);
    }
    const bool renders = options.exported.empty() && !options.print_scene && !options.dry_run;
    if (renders || !options.outputs.empty()) {
        require_outputs(options.outputs, image_name(options.scene));
    }
    for (const std::string &path : {options.state, options.stats, options.exported}) {
        if (!path.empty()) {
            require_writable(path);
        }
    }
}

void apply_options(Options &options, Scene &scene) {
    options.settings.algorithm = &algorithm_named(options.algorithm);
    options.settings.sampler = default_sampler(*options.settings.algorithm);
    for (const std::string &assignment : options.assignments) {
        if (!set_scene_property(scene, assignment)) {
            apply_setting(options.settings, assignment);
        }
    }
    options.settings.only_pass = find_named(pass_kinds, options.passes);
    options.settings.variance = requested(options.layers, "variance");
    options.settings.separate_strategies = requested(options.layers, "strategies");
}

void set_size(Options &options, Scene &scene) {
    if (!options.size.empty()) {
        if (scene.crop() && options.crop.empty()) {
            throw input_error("--size: the scene crops its film; give --crop, too, or --crop none");
        }
        const auto [width, height] = parse_pair(options.size, 'x', "--size");
        if (width < 1 || height < 1 || width > 65536 || height > 65536) {
            throw input_error(
                fmt::format("--size {}: sides must be from 1 to 65536 pixels", options.size));
        }
        scene.set_film_size(static_cast<int>(width), static_cast<int>(height));
    }
    set_crop(options, scene);
    options.settings.width = scene.film_width();
    options.settings.height = scene.film_height();
    if (scene.crop()) {
        set_window(options.settings, *scene.crop(), scene.film_width(), scene.film_height());
    }
}

SampleRange requested_samples(const Options &options) {
    if (options.samples.empty()) {
        return {0, options.spp.value_or(64)};
    }
    const auto [begin, end] = parse_pair(options.samples, ':', "--samples");
    if (begin >= end) {
        throw input_error(fmt::format("--samples {}: BEGIN must be below END", options.samples));
    }
    return {begin, end};
}

void add_output_options(CLI::App &app, std::vector<std::string> &outputs, double &exposure) {
    app.add_option("-o,--output", outputs,
                   "image to write: .exr (linear, with layers), .png or .jpg (for display); may be "
                   "repeated")
        ->allow_extra_args(false);
    app.add_option("--exposure", exposure,
                   "exposure of .png and .jpg in stops: radiance is multiplied by 2^EXPOSURE")
        ->check(number_between(-100.0, 100.0))
        ->capture_default_str();
}

void add_options(CLI::App &app, Options &options) {
    app.add_flag("--list-devices", options.list_devices, "list the OpenCL devices and stop");
    app.add_flag("--list-algorithms", options.list_algorithms, "list the algorithms and stop");
    app.add_option("SCENE", options.scene,
                   "scene (.json, Mitsuba 3 .xml) or model file (.ply, .obj, .gltf, ...)");
    add_output_options(app, options.outputs, options.exposure);
    app.add_option(
        "--export", options.exported,
        "write the scene for Mitsuba 3 (.xml) or Blender's Cycles (.blender.json) and stop");
    app.add_option("--algorithm", options.algorithm, "see --list-algorithms")
        ->capture_default_str();
    app.add_option("--passes", options.passes,
                   "passes to render: all, camera or light; truncated_bdpt has both, for merge")
        ->check(CLI::IsMember({"all", "camera", "light"}))
        ->capture_default_str();
    app.add_option("--spp", options.spp, "samples per pixel (default 64)")
        ->check(positive_number());
    app.add_option("--time", options.seconds,
                   "render for this many seconds instead of a number of samples")
        ->check(positive_number());
    app.add_option("--samples", options.samples,
                   "render only the samples BEGIN:END of every pixel");
    app.add_option("--seed", options.settings.seed, "seed of the random numbers")
        ->capture_default_str();
    app.add_option(
        "--crop", options.crop,
        "window X,Y,WxH of the picture to render, in pixels from its top left corner, or "
        "none (default: the scene's)");
    app.add_option("--size", options.size, "image size WxH in pixels (default: the scene's film)");
    app.add_option("--device", options.device,
                   "gpu, cpu, PLATFORM:DEVICE or part of a name (default: a GPU, else a CPU)");
    app.add_option("--state", options.state, "film file to write, for --resume and merge");
    app.add_option("--checkpoint-interval", options.checkpoint_interval,
                   "seconds between writes of the film of --state")
        ->check(number_from_0())
        ->capture_default_str();
    app.add_option("--preview", options.preview,
                   "write the images while they render, every so many seconds")
        ->check(number_from_0());
    app.add_flag("--resume", options.resume, "continue from the film of --state if it exists");
    app.add_flag("--overwrite", options.overwrite, "replace the film of --state if it exists");
    app.add_option("--set", options.assignments, "change a setting: NAME=VALUE; may be repeated")
        ->allow_extra_args(false);
    add_scene_options(app, options.scene_options);
    app.add_option("--stats", options.stats,
                   "write a .json with features, kernels, bytes, launches and seconds");
    app.add_option("--layers", options.layers, "layers of the EXR besides R,G,B")
        ->delimiter(',')
        ->check(CLI::IsMember({"variance", "samples", "passes", "strategies", "none"}))
        ->capture_default_str();
    auto *print =
        app.add_flag("--print-scene", options.print_scene, "print nodes and properties and stop");
    app.add_flag("--json", options.json, "print the scene as JSON, for programs")->needs(print);
    app.add_flag("--dry-run", options.dry_run,
                 "compile everything and print the statistics; render nothing");
    app.add_flag("-q,--quiet", options.quiet, "print no progress");
}

}  // namespace rtrays
