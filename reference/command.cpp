// SPDX-License-Identifier: MIT
#include "reference/command.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include "reference/manifest.h"
#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/load_scene.h"

namespace rtrays::reference {

namespace fs = std::filesystem;

namespace {

/// Throws `Error` (bad usage) if `image` cannot be listed in a manifest.
void require_listable(const std::string &image, const std::string &manifest) {
    parse_reference_name(image);
    if (fs::absolute(image).parent_path() != fs::absolute(manifest).parent_path()) {
        throw input_error(
            fmt::format("{}: must be in the folder of its manifest {}", image, manifest));
    }
    if (fs::exists(manifest)) {
        load_manifest(manifest);
    }
}

/// Returns the film of the image that the manifest lists if it has these settings and fewer
/// samples. References from another machine come with their image but without their state.
std::optional<Checkpoint> listed_film(const Options &options, const Steps &steps,
                                      const Json &config) {
    const Json entry = manifest_entry(options.manifest, options.output);
    if (entry.is_null()) {
        return std::nullopt;
    }
    const Image image = read_exr(options.output);
    const auto made_with = image.attributes().find("rtrays:config");
    const uint64_t begin = entry.at("sample_range").at(0), end = entry.at("sample_range").at(1);
    if (made_with == image.attributes().end() ||
        std::get<std::string>(made_with->second) != config.dump() || begin != options.begin ||
        end >= options.end) {
        return std::nullopt;
    }
    std::vector<std::string> commits;
    std::istringstream listed(entry.at("commit").get<std::string>());
    for (std::string commit; std::getline(listed, commit, ',');) {
        commits.push_back(commit);
    }
    return Checkpoint{config, Film::of(image, {begin / steps.samples, end / steps.samples}),
                      steps.range, entry.at("seconds"), commits};
}

/// Returns the film of the state file. Throws `Error` (bad input) if it cannot be continued, or
/// would be overwritten unfinished.
std::optional<Checkpoint> stored_film(const Options &options, const Steps &steps,
                                      const Json &config) {
    Checkpoint checkpoint = load_checkpoint(options.state);
    if (options.resume) {
        require_continues(checkpoint, config, steps.range, options.state);
        return checkpoint;
    }
    if (!checkpoint.finished()) {
        throw input_error(fmt::format(
            "{}: holds {} of {} samples of an unfinished run; pass --resume to continue "
            "it, or delete it to start again",
            options.state, steps.samples * checkpoint.film.count(),
            steps.samples * checkpoint.wanted.count()));
    }
    return std::nullopt;
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

/// Loads the states and adds them. Throws `Error` (bad input) naming the file that does not fit.
Checkpoint load_merged(const std::vector<std::string> &paths) {
    Checkpoint merged = load_checkpoint(paths.front());
    if (merged.config.contains("samples_per_step")) {
        throw input_error(
            fmt::format("{}: only states of --engine embree can be merged", paths.front()));
    }
    for (size_t i = 1; i < paths.size(); ++i) {
        try {
            merge_checkpoint(merged, load_checkpoint(paths[i]));
        } catch (const Error &error) {
            throw Error(error.exit_code(), fmt::format("{}: {}", paths[i], error.what()));
        }
    }
    return merged;
}

}  // namespace

void require_outputs(const Options &options) {
    require_exr_output(options.output);
    for (const std::string &path : {options.state, options.stats, options.manifest}) {
        if (!path.empty()) {
            require_writable(path);
        }
    }
    if (options.manifest.empty()) {
        return;
    }
    if (parse_reference_name(options.output).engine != options.engine) {
        throw input_error(
            fmt::format("{}: the name does not match engine {}; expected SCENE.{}.HALF.exr",
                        options.output, options.engine, options.engine));
    }
    require_listable(options.output, options.manifest);
}

Scene load_scene(Options &options) {
    Scene scene = rtrays::load_scene(options.scene, true, options.scene_options);
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
    return scene;
}

bool is_done(const Options &options, const Json &config) {
    if (!options.skip_if_listed || options.begin > 0) {
        return false;
    }
    Json wanted = describe_run(config, {options.begin, options.end});
    wanted.erase("sample_range");
    const bool listed = manifest_lists(options.manifest, options.output, wanted);
    if (listed) {
        fmt::print(stderr,
                   "rtrays-reference: {} is already listed with these settings; nothing to do\n",
                   options.output);
    }
    return listed;
}

Checkpoint begin_or_resume(const Options &options, const Steps &steps, const Json &config) {
    std::optional<Checkpoint> stored;
    if (fs::exists(options.state)) {
        stored = stored_film(options, steps, config);
    } else if (options.resume && !options.manifest.empty()) {
        stored = listed_film(options, steps, config);
    }
    Checkpoint checkpoint =
        stored ? std::move(*stored)
               : Checkpoint{config, Film(options.settings.width, options.settings.height),
                            steps.range, 0, std::vector<std::string>()};
    checkpoint.wanted = steps.range;
    if (!checkpoint.finished()) {
        add_commits(checkpoint.commits, {version()});
    }
    return checkpoint;
}

void write_results(const Options &options, const Steps &steps, const Checkpoint &checkpoint,
                   Image image, Json counts) {
    SampleRanges ranges = checkpoint.film.ranges;
    for (SampleRange &range : ranges) {
        range = {steps.samples * range.begin, steps.samples * range.end};
    }
    write_results({options.output, options.manifest, options.stats},
                  {checkpoint.config, std::move(image), ranges, checkpoint.seconds,
                   checkpoint.commits, std::move(counts)});
    if (!options.quiet) {
        fmt::print(stderr, "wrote {} ({} x {}), {} spp in {:.1f} s\n", options.output,
                   options.settings.width, options.settings.height, count_samples(ranges),
                   checkpoint.seconds);
    }
}

void report_interruption(const Options &options, uint64_t samples) {
    fmt::print(stderr, "rtrays-reference: interrupted after {} of {} spp; continue with --resume\n",
               samples, options.end - options.begin);
}

ExitCode merge_states(const MergeOptions &options) {
    require_exr_output(options.output);
    if (!options.manifest.empty()) {
        require_listable(options.output, options.manifest);
    }
    if (!options.state.empty() && !options.overwrite && fs::exists(options.state)) {
        throw input_error(
            fmt::format("--state {}: the file exists; --overwrite replaces it", options.state));
    }
    const Checkpoint merged = load_merged(options.states);
    write_results({options.output, options.manifest, ""},
                  {merged.config, merged.film.develop(merged.seconds), merged.film.ranges,
                   merged.seconds, merged.commits});
    if (!options.state.empty()) {
        save_checkpoint(merged, options.state);
    }
    return ExitCode::ok;
}

}  // namespace rtrays::reference
