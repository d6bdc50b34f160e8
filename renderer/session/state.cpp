// SPDX-License-Identifier: MIT
// Construction of a session: settings, passes, buffers and bindings; changes of scene and size.
#include "renderer/session/state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/compile/emitter_view.h"
#include "renderer/compile/guide_table.h"
#include "renderer/integrators/count_rays.h"
#include "renderer/integrators/megakernel.h"
#include "renderer/scene/scene.h"
#include "renderer/shared/path_state.h"

namespace rtrays {

namespace {

/// Returns the layout of streams for a device. On a CPU, path states should stay in cache, and a
/// work-item should do enough work to be worth its call. A GPU needs enough paths to hide latency,
/// though no more than its second-level cache holds, and neighbouring work-items should read
/// neighbouring words.
StreamLayout stream_layout(const RenderSettings &settings, const DeviceInfo &info) {
    const BvhLayout bvh = BvhBuildParameters::for_device(info).layout;
    StreamLayout layout = info.is_cpu ? StreamLayout{1, 1u << 14, 64, true, bvh}
                                      : StreamLayout{128, 1u << 18, 1, false, bvh};
    layout.group_size = settings.group_size > 0 ? settings.group_size : layout.group_size;
    layout.capacity = settings.stream_capacity > 0 ? settings.stream_capacity : layout.capacity;
    if (has_light_pass(settings)) {
        // In a round each light path may splat twice, and all splats may go to the same pixel.
        layout.capacity = std::min(layout.capacity, FILM_ADDITIONS_AT_ONCE / 2);
    }
    layout.chunk = settings.stream_chunk > 0 ? settings.stream_chunk : layout.chunk;
    if (settings.path_layout) {
        layout.interleaved = *settings.path_layout == PathLayout::interleaved;
    }
    layout.bvh = settings.bvh_layout.value_or(layout.bvh);
    if (layout.group_size > info.max_group_size) {
        throw input_error(fmt::format("device.group_size={}: '{}' allows at most {}",
                                      layout.group_size, info.name, info.max_group_size));
    }
    return layout;
}

FeatureMask select_features(const CompiledScene &compiled, const RenderSettings &settings,
                            const DeviceInfo &info) {
    FeatureMask features =
        FeatureMask::all()
            .with(Feature::variance, settings.variance)
            .with(Feature::sequences, has_sequence_sums(settings))
            .with(Feature::convergence, has_convergence_control(settings))
            .with(Feature::light_path_trials, settings.light_path_trials)
            .with(Feature::independent_lights, compiled.features.has(Feature::independent_lights));
    if (settings.features == CompiledFeatures::scene) {
        features = settings_features(settings) | compiled.features;
    }
    return features.with(Feature::int64_atomics, info.has_int64_atomics);
}

void require_film_size(int width, int height) {
    const uint64_t pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
    if (width < 1 || height < 1 || pixels > (1u << 30)) {
        throw input_error(
            fmt::format("{} x {} pixels: expected at least 1 and at most 2^30", width, height));
    }
}

RenderSettings complete(RenderSettings settings, const Scene &scene) {
    require_consistent(settings);
    settings = with_fixed_choices(std::move(settings));
    if (settings.width <= 0 && settings.height <= 0 && scene.crop()) {
        set_window(settings, *scene.crop(), scene.film_width(), scene.film_height());
    }
    settings.width = settings.width > 0 ? settings.width : scene.film_width();
    settings.height = settings.height > 0 ? settings.height : scene.film_height();
    require_film_size(settings.width, settings.height);
    return settings;
}

/// Replaces LIGHT_PATHS_AUTO by the number that a pilot chooses, leaves out explicit paths if it
/// does, and sets the guides that it trains. Without light paths there are none. Returns the pilot,
/// which is empty if none was needed.
Pilot apply_pilot(RenderSettings &settings, const std::shared_ptr<DeviceScene> &scene,
                  const Scene &graph) {
    if (trains_scatter_guide(settings) && !is_scatter_guidable(scene->compiled())) {
        settings.guided_scattering = GuidedScattering::off;
    }
    if (!needs_pilot(settings)) {
        return {};
    }
    Pilot pilot = run_pilot(scene, graph, settings);
    if (pilot.emission_guide != nullptr) {
        settings.emission_guide = pilot.emission_guide;
    } else if (trains_emission_guide(settings)) {
        settings.guided_emission = GuidedEmission::off;
    }
    if (pilot.scatter_guide != nullptr) {
        settings.scatter_guide = pilot.scatter_guide;
    } else if (trains_scatter_guide(settings)) {
        settings.guided_scattering = GuidedScattering::off;
    }
    if (settings.light_paths == LIGHT_PATHS_AUTO) {
        settings.light_paths = pilot.light_paths;
        if (!pilot.is_explicit) {
            settings.strategies = PathStrategies::implicit_only;
        }
    }
    return pilot;
}

/// Returns the scene after its update to the current state of `graph`.
std::shared_ptr<DeviceScene> updated(std::shared_ptr<DeviceScene> scene, const Scene &graph,
                                     const RenderSettings &settings) {
    const DeviceSceneSettings wanted = device_scene_settings(settings, scene->device().info());
    if (!(wanted == scene->settings())) {
        throw input_error(
            "sessions that share a scene need the same settings of light selection, sphere "
            "sampling, hierarchy (device.bvh_*) and features; ray_casting and whitted share scenes "
            "with each other only");
    }
    scene->update(graph);
    return scene;
}

}  // namespace

DeviceSceneSettings device_scene_settings(const RenderSettings &requested, const DeviceInfo &info) {
    require_consistent(requested);
    const RenderSettings settings = with_fixed_choices(requested);
    DeviceSceneSettings scene = {compile_settings(settings), BvhBuildParameters::for_device(info),
                                 settings.bvh_update == BvhUpdate::refit};
    scene.bvh.layout = stream_layout(settings, info).bvh;
    choose_builder(settings, scene.bvh);
    return scene;
}

RenderSession::State::State(std::shared_ptr<DeviceScene> shared, const Scene &graph,
                            const RenderSettings &requested)
    : scene(updated(std::move(shared), graph, requested)),
      scene_version(scene->version()),
      scene_features(scene->compiled().features),
      light_count(scene->compiled().lighting.light_count),
      device(scene->device()),
      settings(complete(requested, graph)),
      pilot(apply_pilot(settings, scene, graph)),
      layout(stream_layout(settings, device.info())),
      integrator(integrator_settings(settings)) {
    std::vector<Pass> all_passes = algorithm_passes(
        *settings.algorithm,
        {select_features(scene->compiled(), settings, device.info()), light_count,
         has_light_pass(settings), integrator.light_vertices, settings.separate_strategies});
    if (settings.pipeline == Pipeline::megakernel) {
        all_passes = megakernel_passes(std::move(all_passes));
    }
    if (settings.count_rays == RayCounts::by_depth) {
        all_passes = counting_passes(std::move(all_passes));
    }
    for (const Pass &pass : all_passes) {
        if (!settings.only_pass || *settings.only_pass == pass.kind) {
            passes.emplace_back(pass, device, layout, settings);
            features = features | pass.features;
            compile_seconds += passes.back().stages.build_seconds();
        }
    }
    if (passes.empty()) {
        throw input_error(
            settings.only_pass
                ? fmt::format("{} has no pass '{}' in this scene", settings.algorithm->name,
                              to_string(*settings.only_pass))
                : fmt::format("{}: the scene has no light", settings.algorithm->name));
    }
    set_guides();
    set_config();
    scene->require(graph, features);
    allocate_streams();
    allocate_film();
    bind();
    warm_up();
}

void RenderSession::State::set_guides() {
    if (has_guided_scattering(settings)) {
        scatter_guide = Buffer<uint32_t>(device, "scatter_guide", settings.scatter_guide->words);
    }
    if (!has_guided_emission(settings)) {
        return;
    }
    if (settings.guided_emission == GuidedEmission::flat) {
        settings.emission_guide =
            std::make_shared<const EmissionGuide>(flat_guide(scene->compiled()));
    }
    require_guide_for(scene->compiled(), *settings.emission_guide);
    emission_guide = Buffer<uint32_t>(device, "emission_guide", settings.emission_guide->words);
}

void RenderSession::State::set_config() {
    config = {{"scene", scene->hash()}};
    const nlohmann::json values = image_settings(settings);
    for (const auto &[name, value] : values.items()) {
        config[name] = value.is_string() ? value.get<std::string>() : value.dump();
    }
    const RenderSettings::Window &window = settings.window;
    if (window.full_width > 0) {
        config["crop"] = fmt::format("{} {} of {} x {}", window.x, window.y, window.full_width,
                                     window.full_height);
    }
    // After "scene" in the order of names, because the scene decides them.
    if (has_guided_emission(settings)) {
        config["table of guided emission"] = guide_hash(settings.emission_guide->words);
    }
    if (has_guided_scattering(settings)) {
        config["table of guided scattering"] = guide_hash(settings.scatter_guide->words);
    }
}

bool RenderSession::State::update(const Scene &graph) {
    scene->update(graph);
    if (scene->compiled().features != scene_features ||
        scene->compiled().lighting.light_count != light_count) {
        return false;
    }
    if ((settings.guided_emission == GuidedEmission::trained ||
         settings.guided_scattering == GuidedScattering::trained) &&
        scene_version != scene->version()) {
        return false;
    }
    if (scene_version != scene->version()) {
        set_guides();
        scene_version = scene->version();
        StageArguments arguments = scene_arguments();
        for (CompiledPass &pass : passes) {
            arguments[StageInput::settings] = {settings_of(pass)};
            pass.stages.bind(arguments);
        }
    }
    set_config();
    reset_film();
    return true;
}

void RenderSession::State::resize(int width, int height) {
    require_film_size(width, height);
    RenderSettings resized = settings;
    resized.width = width;
    resized.height = height;
    if (settings.window.full_width > 0) {
        throw input_error("a window of a picture cannot be resized; start a new session");
    }
    if (!pilot.trials.empty()) {
        const double ratio = static_cast<double>(width) * height / static_cast<double>(pixels());
        resized.light_paths = static_cast<uint32_t>(std::lround(settings.light_paths * ratio));
    }
    const RenderSettings former = settings;
    try {
        begin_film(resized);
    } catch (...) {
        begin_film(former);  // the buffers of a film must have its size
        throw;
    }
}

void RenderSession::State::begin_film(const RenderSettings &sized) {
    settings = sized;
    integrator.light_paths = light_paths_per_sample(settings);
    integrator.film_width = integrator.full_width = static_cast<uint32_t>(settings.width);
    set_config();
    allocate_film();
    bind();
    reset_counts();
}

void RenderSession::State::require_current() const {
    if (scene_version != scene->version()) {
        throw input_error("the scene has changed: update the session before it renders");
    }
}

void RenderSession::State::allocate_streams() {
    const uint64_t capacity = layout.capacity;
    uint32_t words = 0, queues_per_path = 0;  // passes reuse memory one after the other
    for (const CompiledPass &pass : passes) {
        words = std::max(words, path_state_words(pass.features));
        queues_per_path = std::max(queues_per_path, pass.queues());
    }
    const bool streams = passes.front().streams;
    path_words = Buffer<uint32_t>(device, "path_states", streams ? capacity * words : 0);
    vertex_words = Buffer<uint32_t>(device, "light_vertices", capacity * vertex_words_per_path());
    branch_vertices = Buffer<uint32_t>(device, "branches", capacity * branch_words_per_path());
    queues = Buffer<uint32_t>(device, "queues", capacity * queues_per_path);
    counters = Buffer<StreamCounters>(device, "counters", 1);
    counters.clear();
}

void RenderSession::State::allocate_trials() {
    const std::vector<uint32_t> pixels_of_lattice =
        pilot_pixels(static_cast<uint32_t>(settings.width), static_cast<uint32_t>(settings.height));
    trial_pixels = Buffer<uint32_t>(device, "trial_pixels", pixels_of_lattice);
    const size_t paths = TRIAL_SAMPLES * pixels_of_lattice.size();
    integrator.training_paths = settings.stores_training_hits ? static_cast<uint32_t>(paths) : 0;
    for (CompiledPass &pass : passes) {
        const bool stores_hits = settings.stores_training_hits && pass.kind == PassKind::light;
        const size_t bytes_of_path =
            sizeof(PathTrials) + (stores_hits ? TRAINING_HITS * sizeof(TrainingHit) : 0);
        pass.film = Buffer<int64_t>(device, "trials", paths * bytes_of_path / sizeof(int64_t));
        if (stores_hits) {
            pass.film.clear();  // paths store only the hits that they have
        }
    }
}

void RenderSession::State::allocate_film() {
    if (settings.light_path_trials) {
        return allocate_trials();
    }
    for (CompiledPass &pass : passes) {
        pass.film =
            Buffer<int64_t>(device, std::string("film.") + to_string(pass.kind), film_words());
        if (settings.count_rays == RayCounts::by_depth) {
            pass.ray_counts = Buffer<int64_t>(
                device, std::string("ray_counts.") + to_string(pass.kind), RAY_KINDS * RAY_DEPTHS);
        }
        pass.clear();
        if (pass.features.has(Feature::convergence)) {
            const ConvergenceRule rule{settings.convergence_error, settings.convergence_interval,
                                       settings.convergence_start};
            convergence = std::make_unique<ConvergenceControl>(
                device, rule, static_cast<uint32_t>(pixels()), pass.features, layout.group_size,
                settings.source_overlays);
        }
    }
}

void RenderSession::State::bind() {
    using In = StageInput;
    StageArguments arguments = scene_arguments();
    arguments[In::film_sums] = {static_cast<uint32_t>(film_sums())};
    arguments[In::first_sample] = {uint64_t{0}};
    arguments[In::light_index] = arguments[In::vertex_index] = {uint32_t{SELECT_LIGHT}};
    arguments[In::first_work] = {uint32_t{0}};
    arguments[In::work] = {uint32_t{0}};
    arguments[In::vertices] = {vertex_words};
    arguments[In::branches] = {branch_vertices};
    arguments[In::streams] = {path_words, queues, counters, layout.capacity};
    arguments[In::counters] = {counters};
    for (CompiledPass &pass : passes) {
        for (auto &[input, bound] : pass.indices) {
            bound = SELECT_LIGHT;
        }
        arguments[In::settings] = {settings_of(pass)};
        arguments[In::film] = {pass.film};
        arguments[In::ray_counts] = {pass.ray_counts};
        // Null pointers, which no kernel reads without convergence control or a pilot.
        arguments[In::half_film] = {Buffer<int64_t>()};
        arguments[In::live_pixels] = {trial_pixels, static_cast<uint32_t>(trial_pixels.size())};
        if (pass.features.has(Feature::convergence)) {
            for (const auto &[input, list] : convergence->arguments()) {
                arguments[input] = list;
            }
        }
        pass.stages.bind(arguments);
    }
}

CameraRecord RenderSession::State::camera() const {
    const RenderSettings::Window &window = settings.window;
    const bool is_full = window.full_width == 0;
    CameraRecord record = scene->camera(is_full ? settings.width : window.full_width,
                                        is_full ? settings.height : window.full_height);
    record.width = static_cast<uint32_t>(settings.width);
    record.height = static_cast<uint32_t>(settings.height);
    record.crop_x = static_cast<uint32_t>(window.x);
    record.crop_y = static_cast<uint32_t>(window.y);
    return record;
}

StageArguments RenderSession::State::scene_arguments() {
    const CameraRecord record = camera();
    emitters_in_view = rtrays::emitters_in_view(scene->compiled(), record);
    StageArguments arguments = scene->arguments(features, emission_guide, scatter_guide);
    arguments[StageInput::camera] = {record};
    return arguments;
}

IntegratorSettings RenderSession::State::settings_of(const CompiledPass &pass) const {
    IntegratorSettings common = integrator;
    common.strategies |= emitters_in_view ? 0u : STRATEGY_EMITTERS_OUT_OF_VIEW;
    return pass.own_settings(common);
}

void RenderSession::State::warm_up() {
    const auto start = SteadyClock::now();
    run_batch(0, 0);
    for (CompiledPass &pass : passes) {
        pass.profile.clear();
    }
    compile_seconds += seconds_since(start);
}

void RenderSession::State::reset_film() {
    for (CompiledPass &pass : passes) {
        pass.clear();
        if (pass.features.has(Feature::convergence)) {
            convergence->reset();
            pass.stages.bind(convergence->arguments());
        }
    }
    reset_counts();
}

void RenderSession::State::reset_counts() {
    counters.clear();
    ranges = FilmState();
    wall_seconds = 0;
    samples = 0;
}

double RenderSession::State::device_seconds() const {
    double seconds = pilot.seconds;
    for (const CompiledPass &pass : passes) {
        seconds += total_seconds(pass.profile);
    }
    return seconds;
}

FilmState RenderSession::State::film_header() const {
    FilmState header = ranges;
    header.width = settings.width;
    header.height = settings.height;
    header.variance = settings.variance;
    header.sequences = has_sequence_sums(settings);
    header.passes.clear();
    for (const CompiledPass &pass : passes) {
        header.passes.push_back(pass.kind);
        header.light_paths =
            pass.kind == PassKind::light ? integrator.light_paths : header.light_paths;
    }
    header.seed = integrator.seed;
    header.config = config;
    if (convergence != nullptr) {
        header.convergence = {convergence->rule(), {}, {}};
    }
    return header;
}

}  // namespace rtrays
