// SPDX-License-Identifier: MIT
// rtrays-render: renders a scene on an OpenCL device.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "renderer/base/clock.h"
#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/notice.h"
#include "renderer/base/progress.h"
#include "renderer/device/context.h"
#include "renderer/export/display_image.h"
#include "renderer/export/export_scene.h"
#include "renderer/import/load_scene.h"
#include "renderer/integrators/unseen_light.h"
#include "renderer/options.h"
#include "renderer/session/render_session.h"

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

void write_images(const Image &image, const std::vector<std::string> &outputs, double exposure) {
    for (const std::string &path : outputs) {
        write_image(image, path, exposure);
    }
}

/// Saves the film of a render whose results cannot be written, in the file of --state or else in
/// the folder for temporary files. Returns a sentence that names the file.
std::string keep_film(const RenderSession &session, const Options &options) {
    const std::string name = fmt::format("rtrays-{}-{}.film", image_name(options.scene), getpid());
    std::error_code none;
    const std::filesystem::path temporary = std::filesystem::temp_directory_path(none) / name;
    std::string reasons;
    for (const std::string &path : {options.state, temporary.string()}) {
        if (path.empty()) {
            continue;
        }
        try {
            save_film(session.film(), path);
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

/// Writes results of a render. If that fails, keeps the samples in a file that the error names.
void write_or_keep(const RenderSession &session, const Options &options,
                   const std::function<void()> &write) {
    try {
        write();
    } catch (const Error &error) {
        throw Error(error.exit_code(),
                    fmt::format("{}\n{}", error.what(), keep_film(session, options)));
    }
}

/// Renders until the options are satisfied; returns false if interrupted before.
bool render(RenderSession &session, const Options &options, SampleRange range) {
    const auto save = [&] {
        if (!options.state.empty()) {
            write_or_keep(session, options, [&] { save_film(session.film(), options.state); });
        }
    };
    const auto start = SteadyClock::now();
    auto last_save = start, last_preview = start;
    const auto keep_up = [&] {
        if (seconds_since(last_save) > options.checkpoint_interval) {
            save();
            last_save = SteadyClock::now();
        }
        if (options.preview && seconds_since(last_preview) > *options.preview) {
            try {
                write_images(select_layers(session.develop(), options.layers), options.outputs,
                             options.exposure);
            } catch (const Error &error) {
                notice(fmt::format("no preview: {}", error.what()));
            }
            last_preview = SteadyClock::now();
        }
    };
    if (options.seconds) {
        Progress progress("rendering", static_cast<uint64_t>(*options.seconds * 1000), "ms",
                          options.quiet);
        uint64_t step = 1;
        while (!interrupted()) {
            const double elapsed = seconds_since(start);
            progress.update(static_cast<uint64_t>(std::min(elapsed, *options.seconds) * 1000));
            if (elapsed >= *options.seconds || session.is_complete()) {
                save();
                return true;
            }
            const double before = session.stats().wall_seconds;
            range.begin = session.render(range.begin, range.begin + step);
            keep_up();
            // A step of about a tenth of the time left, predicted from the last one, keeps the
            // overshoot small.
            const double rate =
                static_cast<double>(step) / std::max(session.stats().wall_seconds - before, 1e-9);
            step = std::max<uint64_t>(
                1, static_cast<uint64_t>(0.1 * (*options.seconds - elapsed) * rate));
        }
    } else {
        Progress progress("rendering", range.end, "spp", options.quiet);
        progress.update(range.begin);
        const uint64_t end = session.render(range.begin, range.end, [&](uint64_t done) {
            progress.update(done);
            keep_up();
        });
        save();
        return end == range.end;
    }
    save();
    return false;
}

/// Continues with the film of --state. Returns the samples of `range` that it lacks.
SampleRange resume(RenderSession &session, const Options &options, SampleRange range) {
    const FilmState film = load_film(options.state);
    session.restore(film);
    for (const SampleRange &present : film.ranges) {
        if (present.begin <= range.begin && range.begin < present.end) {
            range.begin = std::min(present.end, std::max(range.end, range.begin));
        }
    }
    if (options.seconds && !film.ranges.empty()) {
        range.begin = film.ranges.back().end;
    }
    return range;
}

/// Creates a session for the scene at the time of --at. A hierarchy that is refitted is first built
/// at time 0.
RenderSession session_of(Scene &scene, const Options &options, DeviceContext &device) {
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

/// Prints notices of light that the algorithm does not see with its settings.
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

/// Prints what was written, and how long it took.
void print_summary(const RenderSession &session, const Options &options) {
    const RenderStats stats = session.stats();
    const double samples =
        static_cast<double>(stats.samples) / std::max(stats.wall_seconds, 1e-9) / 1e6;
    for (const std::string &path : options.outputs) {
        fmt::print(stderr, "wrote {} ({} x {})\n", path, session.settings().width,
                   session.settings().height);
    }
    fmt::print(stderr, "rendered in {:.1f} s, {:.3g} million samples per second\n",
               stats.wall_seconds, samples);
}

/// Writes the images, if the render is complete, and the statistics.
void write_results(const RenderSession &session, const Options &options, bool complete) {
    // Before the development of the image, which is no part of the render's times.
    const std::string report = options.stats.empty() ? "" : session.report().dump(2) + "\n";
    if (complete) {
        {
            const Waiting waiting("writing the image", options.quiet);
            const Image image = select_layers(session.develop(), options.layers);
            write_or_keep(session, options,
                          [&] { write_images(image, options.outputs, options.exposure); });
        }
        if (!options.quiet) {
            print_summary(session, options);
        }
    }
    if (!options.stats.empty()) {
        write_file(options.stats, report);
    }
}

ExitCode run(Options &options) {
    require_consistent(options);
    Scene scene = load_scene(options.scene, options.quiet, options.scene_options);
    apply_options(options, scene);
    change_view(scene, options.scene_options);
    if (options.print_scene) {
        fmt::print("{}", options.json ? scene.describe_json() : scene.describe());
        return ExitCode::ok;
    }
    set_size(options, scene);
    if (!options.exported.empty()) {
        export_scene(scene, options.exported,
                     {options.spp.value_or(64), options.settings.max_depth});
        return ExitCode::ok;
    }
    SampleRange range = requested_samples(options);
    DeviceContext device(options.device);
    RenderSession session = session_of(scene, options, device);
    notice_unseen_light(scene, options.settings);
    if (options.dry_run) {
        fmt::print("{}\n", session.report().dump(2));
        return ExitCode::ok;
    }
    if (options.resume && std::filesystem::exists(options.state)) {
        range = resume(session, options, range);
    }
    const bool complete = render(session, options, range);
    write_results(session, options, complete);
    if (!complete) {
        fmt::print(stderr, "interrupted{}\n",
                   options.state.empty()
                       ? "; the samples are lost (--state FILM keeps what is done)"
                       : "; continue with --resume --state " + options.state);
        return ExitCode::interrupted;
    }
    return ExitCode::ok;
}

ExitCode merge(const std::vector<std::string> &inputs, const std::vector<std::string> &outputs,
               const std::string &state, bool overwrite, double exposure) {
    require_outputs(outputs, "merged");
    require_new_film(state, overwrite, "--overwrite replaces it");
    FilmState film = load_film(inputs.front());
    for (size_t i = 1; i < inputs.size(); ++i) {
        try {
            merge_film(film, load_film(inputs[i]));
        } catch (const Error &error) {
            throw Error(error.exit_code(), fmt::format("{}: {}", inputs[i], error.what()));
        }
    }
    require_valid(film);
    Image image = develop_film(film);
    describe_image(image, film);
    write_images(image, outputs, exposure);
    if (!state.empty()) {
        save_film(film, state);
    }
    return ExitCode::ok;
}

ExitCode develop(const std::string &input, const std::vector<std::string> &outputs,
                 double exposure) {
    require_outputs(outputs, std::filesystem::path(input).stem().string());
    write_images(read_exr(input), outputs, exposure);
    return ExitCode::ok;
}

/// Parses the arguments of one of the commands. Returns the exit code if the program ends then.
std::optional<ExitCode> parse(CLI::App &app, int argc, char **argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError &error) {
        return app.exit(error) == 0 ? ExitCode::ok : ExitCode::bad_input;
    }
    return std::nullopt;
}

ExitCode parse_and_merge(int argc, char **argv) {
    CLI::App app(
        "Adds films of one scene and one seed with disjoint sample ranges. The image has the same "
        "bits as that of one render.",
        "rtrays-render merge");
    std::vector<std::string> films, outputs;
    std::string state;
    bool overwrite = false;
    double exposure = 0;
    app.add_option("FILM", films, "film files")->required();
    add_output_options(app, outputs, exposure);
    app.add_option("--state", state, "merged film file to write");
    app.add_flag("--overwrite", overwrite, "replace the film of --state if it exists");
    const std::optional<ExitCode> ended = parse(app, argc, argv);
    return ended ? *ended : merge(films, outputs, state, overwrite, exposure);
}

ExitCode parse_and_develop(int argc, char **argv) {
    CLI::App app("Converts an EXR image for display.", "rtrays-render develop");
    std::string input;
    std::vector<std::string> outputs;
    double exposure = 0;
    app.add_option("IN.exr", input, "image to convert")->required();
    add_output_options(app, outputs, exposure);
    const std::optional<ExitCode> ended = parse(app, argc, argv);
    return ended ? *ended : develop(input, outputs, exposure);
}

ExitCode parse_and_render(int argc, char **argv) {
    CLI::App app(
        "Renders a scene on an OpenCL device.\n\n"
        "Other uses:\n"
        "  rtrays-render merge FILM... -o OUT      adds films of one scene\n"
        "  rtrays-render develop IN.exr -o OUT     converts an image for display",
        "rtrays-render");
    app.set_version_flag("--version", program_version("rtrays-render"));
    RenderSettings defaults;
    defaults.sampler = default_sampler(*defaults.algorithm);
    app.footer("Settings (--set NAME=VALUE) and their defaults:\n" + describe_settings(defaults) +
               "  scene.NODE.PROPERTY = ...  any property that --print-scene lists");
    Options options;
    add_options(app, options);
    if (const std::optional<ExitCode> ended = parse(app, argc, argv)) {
        return *ended;
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
    return run(options);
}

ExitCode parse_and_run(int argc, char **argv) {
    install_interrupt_handler();
    const std::string command = argc > 1 ? argv[1] : "";
    if (command == "merge") {
        return parse_and_merge(argc - 1, argv + 1);
    }
    if (command == "develop") {
        return parse_and_develop(argc - 1, argv + 1);
    }
    return parse_and_render(argc, argv);
}

}  // namespace

}  // namespace rtrays

int main(int argc, char **argv) {
    return rtrays::run_main("rtrays-render", [&] { return rtrays::parse_and_run(argc, argv); });
}
