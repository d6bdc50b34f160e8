// SPDX-License-Identifier: MIT
#include "reference/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <iostream>
#include <string_view>

#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/option_checks.h"

namespace rtrays::reference {

namespace {

/// Parses two numbers around a separator. Returns nothing if the text has another form.
template <class Number>
std::optional<std::pair<Number, Number>> parse_pair(const std::string &text, char separator) {
    const size_t middle = text.find(separator);
    if (middle == std::string::npos) {
        return std::nullopt;
    }
    const auto number = [](std::string_view part, Number &value) {
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        return error == std::errc() && end == part.data() + part.size();
    };
    std::pair<Number, Number> result;
    const std::string_view view = text;
    if (!number(view.substr(0, middle), result.first) ||
        !number(view.substr(middle + 1), result.second)) {
        return std::nullopt;
    }
    return result;
}

void apply_size(const std::string &text, ReferenceSettings &settings) {
    constexpr int largest = 1 << 15;
    const auto size = parse_pair<int>(text, 'x');
    if (!size || size->first < 1 || size->second < 1 || size->first > largest ||
        size->second > largest) {
        throw input_error(
            fmt::format("--size '{}': expected WIDTHxHEIGHT in pixels, 1 to {} each, as in 256x256",
                        text, largest));
    }
    settings.width = size->first;
    settings.height = size->second;
}

/// Sets the window of the picture from X,Y,WxH or "none".
void apply_crop(const std::string &text, Options &options) {
    options.uncropped = text == "none";
    if (options.uncropped) {
        return;
    }
    const size_t last = text.rfind(',');
    const auto begin = parse_pair<int>(text.substr(0, last), ',');
    const auto size = parse_pair<int>(text.substr(last + 1), 'x');
    if (!begin || !size) {
        throw input_error(fmt::format(
            "--crop '{}': expected X,Y,WxH in pixels, as in 16,0,32x24, or none", text));
    }
    options.crop = FilmCrop{begin->first, begin->second, size->first, size->second};
}

void apply_range(const std::string &text, Options &options) {
    const auto range = parse_pair<uint64_t>(text, ':');
    if (!range || range->first >= range->second) {
        throw input_error(
            fmt::format("--samples '{}': expected BEGIN:END with BEGIN < END, as in 0:1024", text));
    }
    options.begin = range->first;
    options.end = range->second;
}

/// Parses the arguments. Returns false after --help or --version, which print to stdout. Throws
/// `Error` (bad input) on a usage error.
bool parse(CLI::App &app, int argc, char **argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success &help) {
        app.exit(help, std::cout, std::cerr);
        return false;
    } catch (const CLI::ParseError &error) {
        throw input_error(fmt::format("{} (see --help)", error.what()));
    }
    return true;
}

constexpr const char *manifest_help =
    "add the image to this manifest; the image must be named SCENE.ENGINE.HALF.exr and be in "
    "the folder of the manifest";

}  // namespace

std::optional<MergeOptions> parse_merge_options(int argc, char **argv) {
    MergeOptions options;
    CLI::App app{
        "Adds states of one scene and one seed with disjoint sample ranges. The image has the same "
        "bits as that of one render.",
        "rtrays-reference merge"};
    app.add_option("STATE", options.states, "state files")->required();
    app.add_option("-o,--output", options.output, "output image (OpenEXR)")->required();
    app.add_option("--state", options.state, "merged state file to write");
    app.add_flag("--overwrite", options.overwrite, "replace the file of --state if it exists");
    app.add_option("--manifest", options.manifest, manifest_help);
    return parse(app, argc, argv) ? std::optional(options) : std::nullopt;
}

std::optional<Options> parse_options(int argc, char **argv, Options options) {
    std::string size, crop, range, strategies = name_of(options.settings.strategies);
    CLI::App app{
        "Renders a scene with the independent Embree path tracer, Mitsuba 3 or Blender's Cycles.\n"
        "A state file beside the output stores the progress; --resume continues from it.\n\n"
        "Other uses:\n"
        "  rtrays-reference merge STATE... -o OUT.exr    adds states of one scene",
        "rtrays-reference"};
    app.set_version_flag("--version", program_version("rtrays-reference"));
    app.add_option("SCENE", options.scene, "scene file")->required();
    app.add_option("-o,--output", options.output, "output image (OpenEXR)")->required();
    auto *spp =
        app.add_option("--spp", options.end, "samples per pixel; equivalent to --samples 0:N")
            ->check(positive_number());
    auto *samples = app.add_option("--samples", range, "sample range BEGIN:END")->excludes(spp);
    app.add_option("--seed", options.settings.seed, "random seed")->capture_default_str();
    app.add_option("--engine", options.engine,
                   "renderer: embree, mitsuba or cycles; exit code 77 if it is not installed")
        ->check(CLI::IsMember({"embree", "mitsuba", "cycles"}))
        ->capture_default_str();
    app.add_option("--set", options.assignments,
                   "change a property of the scene: scene.ADDRESS=VALUE, as rtrays-render "
                   "--print-scene lists; may be repeated")
        ->allow_extra_args(false);
    add_scene_options(app, options.scene_options);
    app.add_option("--size", size, "film size WIDTHxHEIGHT; default: the scene's");
    app.add_option(
        "--crop", crop,
        "window X,Y,WxH of the picture to render, in pixels from its top left corner, or none; "
        "default: the scene's");
    app.add_option("--strategies", strategies,
                   "estimators of direct light: implicit, explicit or mis")
        ->capture_default_str();
    app.add_option("--max-depth", options.settings.max_depth,
                   "maximum number of scattering events; 1 is direct light, 0 means no limit")
        ->capture_default_str();
    app.add_option("--threads", options.settings.threads,
                   "number of threads, 0 means all; no effect on the image")
        ->check(number_from_0())
        ->capture_default_str();
    app.add_flag("--resume", options.resume, "continue from the state file if it exists");
    app.add_option("--state", options.state, "state file; default: OUTPUT.state");
    app.add_option("--checkpoint-interval", options.checkpoint_interval,
                   "seconds between writes of the state file, at most 600")
        ->check(number_between(0.0, 600.0))
        ->capture_default_str();
    app.add_option("--stats", options.stats, "JSON file to write counts and times to");
    auto *manifest = app.add_option("--manifest", options.manifest, manifest_help);
    app.add_flag("--skip-if-listed", options.skip_if_listed,
                 "do nothing if the manifest lists the image with these settings and at least as "
                 "many samples")
        ->needs(manifest);
    app.add_flag("-q,--quiet", options.quiet, "do not print progress");
    if (!parse(app, argc, argv)) {
        return std::nullopt;
    }
    if (spp->count() + samples->count() == 0) {
        throw input_error("--spp or --samples is required (see --help)");
    }
    if (samples->count() > 0) {
        apply_range(range, options);
    }
    if (!size.empty()) {
        apply_size(size, options.settings);
    }
    if (!crop.empty()) {
        apply_crop(crop, options);
    }
    options.settings.strategies = strategies_from_name(strategies);
    if (options.engine != "embree" &&
        (samples->count() > 0 || options.settings.strategies != Strategies::mis)) {
        throw input_error(fmt::format(
            "--engine {}: --samples and --strategies require --engine embree", options.engine));
    }
    if (options.state.empty()) {
        options.state = options.output + ".state";
    }
    return options;
}

}  // namespace rtrays::reference
