// SPDX-License-Identifier: MIT
// rtrays-render: renders a scene on an OpenCL device.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "renderer/base/clock.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/command.h"

namespace rtrays {

namespace {

/// Saves films and previews while a session renders.
class Upkeep {
  public:
    Upkeep(const RenderSession &session, const Options &options)
        : session_(session), options_(options) {}

    void save() const {
        if (!options_.state.empty()) {
            save_state(session_.film(), options_);
        }
    }

    /// Does what is due.
    void keep_up() {
        if (seconds_since(last_save_) > options_.checkpoint_interval) {
            save();
            last_save_ = SteadyClock::now();
        }
        if (options_.preview && seconds_since(last_preview_) > *options_.preview) {
            write_preview(session_, session_.film(), options_);
            last_preview_ = SteadyClock::now();
        }
    }

  private:
    const RenderSession &session_;
    const Options &options_;
    SteadyClock::time_point last_save_ = SteadyClock::now(), last_preview_ = last_save_;
};

/// Renders from sample `begin` on for the seconds of --time; returns false if interrupted before.
bool render_for_time(RenderSession &session, const Options &options, uint64_t begin) {
    const auto start = SteadyClock::now();
    Upkeep upkeep(session, options);
    Progress progress("rendering", static_cast<uint64_t>(*options.seconds * 1000), "ms",
                      options.quiet);
    uint64_t step = 1;
    while (!interrupted()) {
        const double elapsed = seconds_since(start);
        progress.update(static_cast<uint64_t>(std::min(elapsed, *options.seconds) * 1000));
        if (elapsed >= *options.seconds || session.is_complete()) {
            upkeep.save();
            return true;
        }
        const double before = session.stats().wall_seconds;
        begin = session.render(begin, begin + step);
        upkeep.keep_up();
        // A step of about a tenth of the time left, predicted from the last one, keeps the
        // overshoot small.
        const double rate =
            static_cast<double>(step) / std::max(session.stats().wall_seconds - before, 1e-9);
        step =
            std::max<uint64_t>(1, static_cast<uint64_t>(0.1 * (*options.seconds - elapsed) * rate));
    }
    upkeep.save();
    return false;
}

/// Renders the missing samples; returns false if interrupted before.
bool render_samples(RenderSession &session, const Options &options, const SampleRanges &missing) {
    Upkeep upkeep(session, options);
    const uint64_t wanted = requested_samples(options).count();
    uint64_t left = count_samples(missing);
    Progress progress("rendering", wanted, "spp", options.quiet);
    progress.update(wanted - left);
    for (const SampleRange &range : missing) {
        const uint64_t left_after = left - range.count();
        const uint64_t end = session.render(range.begin, range.end, [&](uint64_t done) {
            left = left_after + range.end - done;
            progress.update(wanted - left);
            upkeep.keep_up();
        });
        if (end < range.end) {
            break;
        }
    }
    upkeep.save();
    return left == 0;
}

/// Writes the images, if the render is complete, and the statistics.
void write_all_results(const RenderSession &session, const Options &options, bool complete) {
    // Before the development of the image, which is no part of the render's times.
    const std::string report = options.stats.empty() ? "" : session.report().dump(2) + "\n";
    if (complete) {
        write_results(session, session.film(), options);
        if (!options.quiet) {
            const RenderStats stats = session.stats();
            print_summary(options, stats.samples, stats.wall_seconds);
        }
    }
    if (!options.stats.empty()) {
        write_file(options.stats, report);
    }
}

ExitCode run(Options &options) {
    require_consistent(options);
    std::optional<Scene> scene = load_scene(options);
    if (!scene) {
        return ExitCode::ok;
    }
    requested_samples(options);  // an error of usage before anything is compiled
    DeviceContext device(options.device);
    RenderSession session = make_session(*scene, options, device);
    notice_unseen_light(*scene, options.settings);
    if (options.dry_run) {
        fmt::print("{}\n", session.report().dump(2));
        return ExitCode::ok;
    }
    const SampleRanges missing = resume(session, options);
    const bool complete = options.seconds ? render_for_time(session, options, missing.front().begin)
                                          : render_samples(session, options, missing);
    write_all_results(session, options, complete);
    if (!complete) {
        print_interruption(options);
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
    Options options;
    const std::optional<ExitCode> ended =
        parse_render("rtrays-render",
                     "Renders a scene on an OpenCL device.\n\n"
                     "Other uses:\n"
                     "  rtrays-render merge FILM... -o OUT      adds films of one scene\n"
                     "  rtrays-render develop IN.exr -o OUT     converts an image for display",
                     argc, argv, options);
    return ended ? *ended : run(options);
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
