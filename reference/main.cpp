// SPDX-License-Identifier: MIT
// rtrays-reference: renders a scene with the independent Embree path tracer, with Mitsuba or with
// Cycles.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>

#include "reference/checkpoint.h"
#include "reference/manifest.h"
#include "reference/options.h"
#include "reference/output.h"
#include "reference/peer.h"
#include "reference/renderer.h"
#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/import/load_scene.h"

namespace {

using namespace rtrays;
using namespace rtrays::reference;

namespace fs = std::filesystem;

void check_outputs(const Options &options) {
    require_exr_output(options.output);
    for (const std::string &path : {options.state, options.stats, options.manifest}) {
        if (!path.empty()) {
            require_writable(path);
        }
    }
    if (!options.manifest.empty()) {
        if (parse_reference_name(options.output).engine != options.engine) {
            throw input_error(
                fmt::format("{}: the name does not match engine {}; expected SCENE.{}.HALF.exr",
                            options.output, options.engine, options.engine));
        }
        if (fs::absolute(options.output).parent_path() !=
            fs::absolute(options.manifest).parent_path()) {
            throw input_error(fmt::format("{}: must be in the folder of its manifest {}",
                                          options.output, options.manifest));
        }
        if (fs::exists(options.manifest)) {
            load_manifest(options.manifest);
        }
    }
}

/// The range to render, in steps of the renderer.
struct Steps {
    uint64_t begin = 0, end = 0;
    uint64_t samples = 1;  ///< samples per pixel of one step
};

/// Continues the image that the manifest lists if it has these settings and fewer samples.
/// References from another machine come with their image but without their state. Returns the
/// commits that worked on the image, or an empty list if it cannot be continued.
template <class Renderer>
std::vector<std::string> continue_listed(const Options &options, const Steps &steps,
                                         const Json &config, Renderer &renderer) {
    const Json entry = manifest_entry(options.manifest, options.output);
    if (entry.is_null()) {
        return {};
    }
    const Image image = read_exr(options.output);
    const auto made_with = image.attributes().find("rtrays:config");
    const uint64_t begin = entry.at("sample_range").at(0), end = entry.at("sample_range").at(1);
    if (made_with == image.attributes().end() ||
        std::get<std::string>(made_with->second) != config.dump() || begin != options.begin ||
        end >= options.end) {
        return {};
    }
    renderer.restore(Film::of(image, begin / steps.samples, end / steps.samples),
                     entry.at("seconds"));
    std::vector<std::string> commits;
    std::istringstream listed(entry.at("commit").get<std::string>());
    for (std::string commit; std::getline(listed, commit, ',');) {
        commits.push_back(commit);
    }
    return commits;
}

/// Restores the state file if --resume is given and the file exists. Otherwise continues a listed
/// image. Throws `Error` (bad input) instead of overwriting an unfinished state. Returns the
/// commits that worked on the film, including this program's if there is work left.
template <class Renderer>
std::vector<std::string> begin_or_resume(const Options &options, const Steps &steps,
                                         const Json &config, Renderer &renderer) {
    std::vector<std::string> commits;
    if (fs::exists(options.state)) {
        Checkpoint checkpoint = load_checkpoint(options.state);
        if (options.resume) {
            require_continues(checkpoint, config, steps.begin, steps.end, options.state);
            commits = checkpoint.commits;
            renderer.restore(std::move(checkpoint.film), checkpoint.seconds);
        } else if (!checkpoint.finished()) {
            throw input_error(fmt::format(
                "{}: holds {} of {} samples of an unfinished run; pass --resume to continue "
                "it, or delete it to start again",
                options.state, steps.samples * checkpoint.film.count(),
                steps.samples * (checkpoint.target - checkpoint.film.begin)));
        }
    } else if (options.resume && !options.manifest.empty()) {
        commits = continue_listed(options, steps, config, renderer);
    }
    const std::string made_by = version();
    const bool has_work = renderer.samples() < steps.end - steps.begin;
    if (has_work && std::find(commits.begin(), commits.end(), made_by) == commits.end()) {
        commits.push_back(made_by);
    }
    return commits;
}

/// Returns whether the manifest lists a result that satisfies the request. A longer range with the
/// same start is sufficient.
bool is_listed(const Options &options, const Json &config) {
    Json wanted = describe_run(options, config, options.end - options.begin);
    wanted.erase("sample_range");
    return options.begin == 0 && manifest_lists(options.manifest, options.output, wanted);
}

/// Renders the missing samples and writes the results. `counts` returns further statistics.
template <class Renderer, class Counts>
ExitCode render_reference(const Options &options, const Steps &steps, const Json &config,
                          Renderer &renderer, const Counts &counts) {
    if (options.skip_if_listed && is_listed(options, config)) {
        fmt::print(stderr,
                   "rtrays-reference: {} is already listed with these settings; nothing to do\n",
                   options.output);
        return ExitCode::ok;
    }
    const std::vector<std::string> commits = begin_or_resume(options, steps, config, renderer);

    install_interrupt_handler();
    const auto save = [&] {
        save_checkpoint({config, renderer.film(), steps.end, renderer.seconds(), commits},
                        options.state);
    };
    {
        Progress progress(fs::path(options.output).filename().string(), options.end - options.begin,
                          "spp", options.quiet);
        progress.update(steps.samples * renderer.samples());
        auto last_save = std::chrono::steady_clock::now();
        uint64_t done = steps.begin + renderer.samples();
        while (done < steps.end && !interrupted()) {
            done = renderer.render(done, std::min(steps.end, done + renderer.batch_size()));
            progress.update(steps.samples * renderer.samples());
            const auto now = std::chrono::steady_clock::now();
            if (std::chrono::duration<double>(now - last_save).count() >=
                options.checkpoint_interval) {
                save();
                last_save = now;
            }
        }
    }
    save();
    const Film &film = renderer.film();
    if (film.end < steps.end) {
        fmt::print(stderr,
                   "rtrays-reference: interrupted after {} of {} spp; continue with --resume\n",
                   steps.samples * renderer.samples(), options.end - options.begin);
        return ExitCode::interrupted;
    }
    write_results(options, config,
                  {renderer.develop(), steps.samples * film.begin, steps.samples * film.end,
                   renderer.seconds(), counts()},
                  commits);
    if (!options.quiet) {
        fmt::print(stderr, "wrote {} ({} x {}), {} spp in {:.1f} s\n", options.output,
                   options.settings.width, options.settings.height, options.end - options.begin,
                   renderer.seconds());
    }
    return ExitCode::ok;
}

ExitCode render_by_embree(const Options &options, const Scene &scene) {
    ReferenceRenderer renderer(scene.arrays(), options.settings);
    const Json config =
        make_config(scene.name(), scene.hash(), options.settings, renderer.stats().engine);
    return render_reference(options, {options.begin, options.end, 1}, config, renderer,
                            [&] { return describe_counts(renderer); });
}

/// Renders with another program. The number of samples is rounded up to whole steps.
ExitCode render_by_peer(Options options, Scene &scene) {
    scene.set_film_size(options.settings.width, options.settings.height);
    PeerRenderer renderer(scene, options.settings, options.engine, options.state + ".scene");
    const uint64_t samples = renderer.samples_per_step();
    const Steps steps{0, renderer.steps_for(options.end), samples};
    options.end = samples * steps.end;
    renderer.plan(steps.end);
    Json config = make_config(scene.name(), scene.hash(), options.settings, renderer.engine());
    config["samples_per_step"] = samples;
    return render_reference(options, steps, config, renderer, [] { return Json::object(); });
}

/// Sets the size of the picture and its window: those of the command line, or the scene's.
void set_film(Options &options, Scene &scene) {
    ReferenceSettings &settings = options.settings;
    if (settings.width > 0) {
        if (scene.crop() && !options.crop && !options.uncropped) {
            throw input_error("--size: the scene crops its film; give --crop, too, or --crop none");
        }
        scene.set_film_size(settings.width, settings.height);
    }
    if (options.crop) {
        scene.set_crop(*options.crop);
    } else if (options.uncropped) {
        scene.set_film_size(scene.film_width(), scene.film_height());
    }
    settings.width = scene.film_width();
    settings.height = scene.film_height();
    if (const auto &crop = scene.crop()) {
        if (!options.manifest.empty() || options.engine != "embree") {
            throw input_error("a crop of the film excludes --manifest and other engines");
        }
        settings.full_width = std::exchange(settings.width, crop->width);
        settings.full_height = std::exchange(settings.height, crop->height);
        settings.crop_x = crop->x;
        settings.crop_y = crop->y;
    }
}

ExitCode run(int argc, char **argv) {
    auto parsed = parse_options(argc, argv);
    if (!parsed) {
        return ExitCode::ok;
    }
    Options &options = *parsed;
    check_outputs(options);
    Scene scene = load_scene(options.scene, true, options.scene_options);
    for (const std::string &assignment : options.assignments) {
        if (!set_scene_property(scene, assignment)) {
            throw input_error(fmt::format(
                "--set {}: expected scene.ADDRESS=VALUE; the reference has no other settings",
                assignment));
        }
    }
    change_view(scene, options.scene_options);
    set_film(options, scene);
    options.settings.camera = static_cast<size_t>(scene.active_camera());
    return options.engine == "embree" ? render_by_embree(options, scene)
                                      : render_by_peer(options, scene);
}

}  // namespace

int main(int argc, char **argv) {
    return rtrays::run_main("rtrays-reference", [&] { return run(argc, argv); });
}
