// SPDX-License-Identifier: MIT
// rtrays-reference: renders a scene with the independent Embree path tracer.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>

#include "reference/checkpoint.h"
#include "reference/manifest.h"
#include "reference/options.h"
#include "reference/output.h"
#include "reference/renderer.h"
#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/scene/scene.h"

namespace {

using namespace rtrays;
using namespace rtrays::reference;

namespace fs = std::filesystem;

void check_outputs(const Options &options) {
    for (const std::string &path : {options.output, options.state, options.stats, options.manifest}) {
        if (!path.empty()) {
            require_writable(path);
        }
    }
    if (!options.manifest.empty()) {
        if (const std::string engine = parse_reference_name(options.output).engine; engine != "embree") {
            throw input_error(fmt::format("{}: the engine is embree, not {}; name it SCENE.embree.HALF.exr",
                                          options.output, engine));
        }
        if (fs::absolute(options.output).parent_path() != fs::absolute(options.manifest).parent_path()) {
            throw input_error(
                fmt::format("{}: must lie beside its manifest {}", options.output, options.manifest));
        }
        if (fs::exists(options.manifest)) {
            load_manifest(options.manifest);
        }
    }
}

/// Goes on from the image that the manifest lists with these settings and fewer samples: of references that were made
/// elsewhere the image is there, the state is not. Returns the commits that worked on it.
std::vector<std::string> continue_listed(const Options &options, const Json &config, ReferenceRenderer &renderer) {
    const Json entry = manifest_entry(options.manifest, options.output);
    if (entry.is_null()) {
        return {};
    }
    const Image image = read_exr(options.output);
    const auto made_with = image.attributes().find("rtrays:config");
    const uint64_t begin = entry.at("sample_range").at(0), end = entry.at("sample_range").at(1);
    if (made_with == image.attributes().end() || std::get<std::string>(made_with->second) != config.dump() ||
        begin != options.begin || end >= options.end) {
        return {};
    }
    renderer.restore(Film::of(image, begin, end), entry.at("seconds"));
    std::vector<std::string> commits;
    std::istringstream listed(entry.at("commit").get<std::string>());
    for (std::string commit; std::getline(listed, commit, ',');) {
        commits.push_back(commit);
    }
    return commits;
}

/// Restores the state file when asked to, or continues a listed image; refuses to overwrite a state that is not finished.
/// Returns the commits that worked on the film, this program's included.
std::vector<std::string> begin_or_resume(const Options &options, const Json &config,
                                         ReferenceRenderer &renderer) {
    std::vector<std::string> commits;
    if (fs::exists(options.state)) {
        Checkpoint checkpoint = load_checkpoint(options.state);
        if (options.resume) {
            require_continues(checkpoint, config, options.begin, options.end, options.state);
            commits = checkpoint.commits;
            renderer.restore(std::move(checkpoint.film), checkpoint.seconds);
        } else if (!checkpoint.finished()) {
            throw input_error(fmt::format(
                "{}: holds {} of {} samples of an unfinished run; pass --resume to continue "
                "it, or delete it to start anew",
                options.state, checkpoint.film.count(), checkpoint.target - checkpoint.film.begin));
        }
    } else if (options.resume && !options.manifest.empty()) {
        commits = continue_listed(options, config, renderer);
    }
    const std::string made_by = version();
    const bool has_work = renderer.samples() < options.end - options.begin;
    if (has_work && std::find(commits.begin(), commits.end(), made_by) == commits.end()) {
        commits.push_back(made_by);
    }
    return commits;
}

/// Whether the manifest lists a result that serves as well; a longer range with the same start does.
bool is_listed(const Options &options, const Json &config) {
    Json wanted = describe_run(options, config, options.end - options.begin);
    wanted.erase("sample_range");
    return options.begin == 0 && manifest_lists(options.manifest, options.output, wanted);
}

ExitCode run(int argc, char **argv) {
    auto parsed = parse_options(argc, argv);
    if (!parsed) {
        return ExitCode::ok;
    }
    Options &options = *parsed;
    check_outputs(options);
    const Scene scene = load_scene(options.scene);
    if (options.settings.width == 0) {
        options.settings.width = scene.film_width();
        options.settings.height = scene.film_height();
    }
    options.settings.camera = static_cast<size_t>(scene.active_camera());
    ReferenceRenderer renderer(scene.arrays(), options.settings);
    const Json config = make_config(scene.name(), scene.hash(), options.settings, renderer.stats().engine);
    if (options.skip_if_listed && is_listed(options, config)) {
        fmt::print(stderr, "rtrays-reference: {} is listed already with these settings: nothing to do\n",
                   options.output);
        return ExitCode::ok;
    }
    const std::vector<std::string> commits = begin_or_resume(options, config, renderer);

    install_interrupt_handler();
    const auto save = [&] {
        save_checkpoint({config, renderer.film(), options.end, renderer.seconds(), commits}, options.state);
    };
    {
        Progress progress(fs::path(options.output).filename().string(), options.end - options.begin, "spp",
                          options.quiet);
        progress.update(renderer.samples());
        auto last_save = std::chrono::steady_clock::now();
        uint64_t done = options.begin + renderer.samples();
        while (done < options.end && !interrupted()) {
            done = renderer.render(done, std::min(options.end, done + renderer.batch_size()));
            progress.update(renderer.samples());
            const auto now = std::chrono::steady_clock::now();
            if (std::chrono::duration<double>(now - last_save).count() >= options.checkpoint_interval) {
                save();
                last_save = now;
            }
        }
    }
    save();
    if (renderer.film().end < options.end) {
        fmt::print(stderr, "rtrays-reference: interrupted after {} of {} spp; continue with --resume\n",
                   renderer.samples(), options.end - options.begin);
        return ExitCode::interrupted;
    }
    write_results(options, config, renderer, commits);
    return ExitCode::ok;
}

}  // namespace

int main(int argc, char **argv) {
    return rtrays::run_main("rtrays-reference", [&] { return run(argc, argv); });
}
