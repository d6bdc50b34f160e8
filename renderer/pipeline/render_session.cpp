// SPDX-License-Identifier: MIT
#include "renderer/pipeline/render_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/base/progress.h"
#include "renderer/bvh/builder.h"
#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/count_rays.h"
#include "renderer/integrators/megakernel.h"
#include "renderer/pipeline/convergence_control.h"
#include "renderer/pipeline/pilot.h"
#include "renderer/pipeline/scene_buffers.h"
#include "renderer/pipeline/stages.h"
#include "renderer/scene/scene.h"
#include "renderer/shared/branch.h"
#include "renderer/shared/film_layout.h"
#include "renderer/shared/light_vertex.h"
#include "renderer/shared/path_state.h"
#include "renderer/shared/ray_counts.h"
#include "renderer/shared/stream_counters.h"
#include "rtrays_commit.h"

namespace rtrays {

namespace {

using Clock = std::chrono::steady_clock;

/// Samples of one batch: about this many paths, so that progress shows and an interrupt is heeded within seconds. The
/// work counter has 32 bits.
constexpr uint64_t batch_paths = 1u << 21;

/// Rounds enqueued between two looks at the counters.
constexpr int rounds_per_check = 8;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// On a CPU the path states should stay in cache and a work-item should do enough to be worth its call; a GPU needs
/// enough paths to hide latency, and neighbouring work-items that read neighbouring words.
StreamLayout stream_layout(const RenderSettings &settings, const DeviceInfo &info) {
    const BvhLayout bvh = BvhBuildParameters::for_device(info).layout;
    StreamLayout layout = info.is_cpu ? StreamLayout{1, 1u << 14, 64, true, bvh} : StreamLayout{128, 1u << 20, 1, false, bvh};
    layout.group_size = settings.group_size > 0 ? settings.group_size : layout.group_size;
    layout.capacity = settings.stream_capacity > 0 ? settings.stream_capacity : layout.capacity;
    layout.chunk = settings.stream_chunk > 0 ? settings.stream_chunk : layout.chunk;
    layout.interleaved = settings.path_layout == "auto" ? layout.interleaved : settings.path_layout == "interleaved";
    for (const NamedBvhLayout &named : bvh_layouts) {
        layout.bvh = settings.bvh_layout == named.name ? named.layout : layout.bvh;
    }
    if (layout.group_size > info.max_group_size) {
        throw input_error(fmt::format("device.group_size={}: '{}' allows at most {}", layout.group_size, info.name,
                                      info.max_group_size));
    }
    return layout;
}

FeatureMask select_features(const CompiledScene &compiled, const RenderSettings &settings, const DeviceInfo &info) {
    FeatureMask features = FeatureMask::all().with(Feature::variance, settings.variance)
                               .with(Feature::convergence, has_convergence_control(settings))
                               .with(Feature::independent_lights, compiled.features.has(Feature::independent_lights));
    if (settings.features == "scene") {
        features = settings_features(settings) | compiled.features;
    }
    return features.with(Feature::int64_atomics, info.has_int64_atomics);
}

RenderSettings complete(RenderSettings settings, const Scene &scene) {
    require_consistent(settings);
    settings = with_fixed_choices(std::move(settings));
    settings.width = settings.width > 0 ? settings.width : scene.film_width();
    settings.height = settings.height > 0 ? settings.height : scene.film_height();
    const uint64_t pixels = static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height);
    if (pixels > (1u << 30)) {
        throw input_error(fmt::format("{} x {} pixels are more than 2^30", settings.width, settings.height));
    }
    return settings;
}

/// Replaces LIGHT_PATHS_AUTO by what a pilot chooses.
Pilot settle_light_paths(RenderSettings &settings, const Scene &scene, DeviceContext &device) {
    if (settings.light_paths != LIGHT_PATHS_AUTO) {
        return {};
    }
    Pilot pilot = choose_light_paths(scene, settings, device);
    settings.light_paths = pilot.light_paths;
    return pilot;
}

/// A pass of the algorithm, compiled, with the film it adds to.
struct CompiledPass {
    CompiledPass(const Pass &pass, DeviceContext &device, const StreamLayout &layout, const RenderSettings &settings)
        : name(pass.name),
          features(pass.features),
          round(pass.round),
          adds_hits(pass.adds_hits),
          streams(pass.streams),
          stages(device, stage_names(pass), pass.features, layout, settings.source_overlays) {}

    static std::vector<std::string> stage_names(const Pass &pass) {
        std::vector<std::string> names = {"carry_film"};
        if (pass.streams) {
            names.emplace_back("reset_streams");
        }
        for (const RoundStage &stage : pass.round) {
            names.push_back(stage.name);
        }
        return names;
    }

    /// The integrator's numbers for this pass.
    IntegratorSettings numbers(IntegratorSettings of_all) const {
        of_all.strategies |= adds_hits ? 0u : STRATEGY_HITS_ELSEWHERE;
        return of_all;
    }

    /// Empties what rendering added to.
    void clear() {
        film.fill(0);
        if (ray_counts.size() > 0) {
            ray_counts.fill(0);
        }
        profile.clear();
    }

    /// Rays of one kind (RAY_*) by depth, up to the last depth that has any.
    std::vector<int64_t> rays_by_depth(size_t kind) const {
        const std::vector<int64_t> all = ray_counts.read();
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(kind * RAY_DEPTHS);
        std::vector<int64_t> rays(first, first + RAY_DEPTHS);
        while (!rays.empty() && rays.back() == 0) {
            rays.pop_back();
        }
        return rays;
    }

    std::string name;
    FeatureMask features;
    std::vector<RoundStage> round;
    bool adds_hits;
    bool streams;
    StageSet stages;
    Buffer<int64_t> film;
    Buffer<int64_t> ray_counts;
    uint32_t chosen = SELECT_LIGHT;  ///< what StageInput::chosen is bound to
    uint64_t additions = 0;          ///< to one pixel since the last carry, at most
    std::map<std::string, Profiler::Stage> profile;  ///< of the stages of `render`
};

}  // namespace

struct RenderSession::State {
    State(const Scene &scene, const RenderSettings &requested, DeviceContext &device_context)
        : device(device_context),
          settings(complete(requested, scene)),
          pilot(settle_light_paths(settings, scene, device_context)),
          layout(stream_layout(settings, device_context.info())),
          numbers(integrator_settings(settings)),
          compiled(compile_scene(scene, compile_settings(settings))) {
        std::vector<Pass> all_passes =
            algorithm_passes(scheduled_algorithm(settings), select_features(compiled, settings, device.info()),
                             compiled.lighting.light_count, numbers.light_vertices, settings.strategies_apart);
        if (settings.pipeline == "megakernel") {
            all_passes = megakernel_passes(std::move(all_passes));
        }
        if (settings.count_rays == "by_depth") {
            all_passes = counting_passes(std::move(all_passes));
        }
        for (const Pass &pass : all_passes) {
            if (settings.passes == "all" || settings.passes == pass.name) {
                passes.emplace_back(pass, device, layout, settings);
                features = features | pass.features;
                compile_seconds += passes.back().stages.build_seconds();
            }
        }
        if (passes.empty()) {
            throw input_error(settings.passes == "all"
                                  ? fmt::format("{}: the scene has no light", settings.algorithm)
                                  : fmt::format("{} has no pass '{}' in this scene", settings.algorithm, settings.passes));
        }
        scene_hash = scene.hash();
        config = content_hash(scene_hash + image_settings(settings).dump());
        if (features.has(Feature::triangles)) {
            build_bvh(scene.meshes());
        }
        allocate();
        bind();
        warm_up();
    }

    uint64_t pixels() const { return static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height); }

    void build_bvh(const MeshArrays &meshes) {
        BvhBuildParameters parameters = BvhBuildParameters::for_device(device.info());
        parameters.layout = layout.bvh;
        BvhBuilder builder(device, parameters);
        const auto start = Clock::now();
        bvh = builder.build(meshes.position, meshes.triangle);
        device.finish();
        bvh_wall_seconds = seconds_since(start);
        bvh_stages = device.profiler().take();
    }

    void allocate() {
        const uint64_t capacity = layout.capacity;
        scene_buffers = SceneBuffers(device, compiled, features);
        uint32_t words = 0;  // the passes take turns
        for (const CompiledPass &pass : passes) {
            words = std::max(words, path_state_words(pass.features));
        }
        const bool streams = passes.front().streams;
        path_words = Buffer<uint32_t>(device, "path_states", streams ? capacity * words : 0);
        vertex_words = Buffer<uint32_t>(device, "light_vertices", capacity * vertex_words_per_path());
        branch_vertices = Buffer<uint32_t>(device, "branches", capacity * branch_words_per_path());
        queues = Buffer<uint32_t>(device, "queues", streams ? capacity * STREAM_QUEUES : 0);
        counters = Buffer<StreamCounters>(device, "counters", 1);
        counters.write({StreamCounters{}});
        for (CompiledPass &pass : passes) {
            pass.film = Buffer<int64_t>(device, "film." + pass.name, film_words());
            if (settings.count_rays == "by_depth") {
                pass.ray_counts = Buffer<int64_t>(device, "ray_counts." + pass.name, RAY_KINDS * RAY_DEPTHS);
            }
            pass.clear();
            if (pass.features.has(Feature::convergence)) {
                const ConvergenceRule rule{settings.convergence_error, settings.convergence_interval, settings.convergence_start};
                convergence = std::make_unique<ConvergenceControl>(device, rule, static_cast<uint32_t>(pixels()), pass.features,
                                                                   layout.group_size, settings.source_overlays);
            }
        }
    }

    void bind() {
        using In = StageInput;
        StageArguments arguments = scene_buffers.arguments(bvh);
        arguments[In::camera] = {compiled.camera};
        arguments[In::film_sums] = {static_cast<uint32_t>(film_sums())};
        arguments[In::first_sample] = {uint64_t{0}};
        arguments[In::chosen] = {uint32_t{SELECT_LIGHT}};
        arguments[In::first_work] = {uint32_t{0}};
        arguments[In::work] = {uint32_t{0}};
        arguments[In::vertices] = {};
        if (features.has(Feature::vertex_joins)) {
            arguments[In::vertices] = {vertex_words};
        }
        arguments[In::branches] = {};
        if (features.has(Feature::branches)) {
            arguments[In::branches] = {branch_vertices};
        }
        arguments[In::streams] = {path_words, queues, counters, layout.capacity};
        arguments[In::counters] = {counters};
        for (CompiledPass &pass : passes) {
            arguments[In::settings] = {pass.numbers(numbers)};
            arguments[In::film] = {pass.film};
            arguments[In::ray_counts] = {pass.ray_counts};
            arguments[In::half_film] = arguments[In::live_pixels] = {};
            if (pass.features.has(Feature::convergence)) {
                for (const auto &[input, list] : convergence->arguments()) {
                    arguments[input] = list;
                }
            }
            pass.stages.bind(arguments);
        }
    }

    /// 4-byte words of the light vertices that are kept for every path in flight.
    uint32_t vertex_words_per_path() const {
        return features.has(Feature::vertex_joins) ? numbers.light_vertices * light_vertex_words(features) : 0;
    }

    /// Likewise of the vertices to which each path in flight may come back.
    uint32_t branch_words_per_path() const {
        return features.has(Feature::branches) ? numbers.max_depth * branch_words(features) : 0;
    }

    uint64_t film_words() const { return pixels() * FILM_PIXEL_WORDS(settings.variance); }
    uint64_t film_sums() const { return film_words() / FILM_WORDS; }

    /// Paths of a pass in one sample of the image.
    uint64_t paths_per_sample(const CompiledPass &pass) const {
        return pass.name == "light" ? numbers.light_paths : pixels();
    }
    /// Of these, those that are still traced.
    uint64_t live_paths_per_sample(const CompiledPass &pass) const {
        return pass.features.has(Feature::convergence) ? convergence->live_count() : paths_per_sample(pass);
    }
    uint64_t live_paths_per_sample() const {
        uint64_t paths = 0;
        for (const CompiledPass &pass : passes) {
            paths += live_paths_per_sample(pass);
        }
        return paths;
    }

    /// How many of the samples from `begin` on are rendered next: a batch, up to the next check.
    uint64_t batch_size(uint64_t begin, uint64_t end) const {
        const uint64_t batch = batch_paths / std::max<uint64_t>(1, live_paths_per_sample());
        uint64_t count = std::min(std::clamp<uint64_t>(batch, 1, FILM_ADDITIONS_BETWEEN_CARRIES), end - begin);
        if (convergence != nullptr && convergence->live_count() > 0) {
            count = std::min(count, convergence->rule().next_check(begin) - begin);
        }
        return count;
    }

    /// Where convergence control stops a pixel depends on all samples before.
    void require_next(uint64_t begin, uint64_t end) const {
        const uint64_t done = ranges.samples();
        if (convergence != nullptr && begin < end && begin != done) {
            throw input_error(fmt::format("convergence control decides by all samples from 0 on, of which there are {}: the next is {}, not {}",
                                          done, done, begin));
        }
    }

    /// The first enqueue of a kernel compiles it for its group size: a batch without work does that.
    void warm_up() {
        const auto start = Clock::now();
        run_batch(0, 0);
        for (CompiledPass &pass : passes) {
            pass.profile.clear();
        }
        compile_seconds += seconds_since(start);
    }

    /// `paths`: what a stage that traces whole paths is to trace.
    void enqueue(CompiledPass &pass, const std::string &name, uint64_t paths = 0) {
        using Items = StageDescription::Items;
        switch (stage_description(name).items) {
        case Items::entries:
            return pass.stages.enqueue(name, (layout.capacity + layout.chunk - 1) / layout.chunk);
        case Items::paths:
            return pass.stages.enqueue(name, (paths + layout.chunk - 1) / layout.chunk);
        case Items::slots:
            return pass.stages.enqueue(name, layout.capacity);
        case Items::film_sums:
            return pass.stages.enqueue(name, film_sums());
        case Items::one:
            return pass.stages.enqueue(name, 1);
        }
    }

    /// Stages share what is chosen: it is bound where the next to take it asks for another.
    static void bind_chosen(CompiledPass &pass, const RoundStage &stage) {
        const auto &inputs = stage_description(stage.name).inputs;
        if (stage.chosen != pass.chosen && std::find(inputs.begin(), inputs.end(), StageInput::chosen) != inputs.end()) {
            pass.stages.bind({{StageInput::chosen, {stage.chosen}}});
            pass.chosen = stage.chosen;
        }
    }

    /// Renders `count` samples of the image from `first` on.
    void run_batch(uint64_t first, uint64_t count) {
        if (features.has(Feature::vertex_joins)) {
            // One path of each pass for every pixel: chunk by chunk, so that both find the same light vertices.
            const auto work = static_cast<uint32_t>(count * pixels());
            for (uint32_t begin = 0; begin == 0 || begin < work; begin += layout.capacity) {
                for (CompiledPass &pass : passes) {
                    run_pass(pass, first, begin, std::min(begin + layout.capacity, work));
                }
            }
        } else {
            for (CompiledPass &pass : passes) {
                const auto work = static_cast<uint32_t>(count * live_paths_per_sample(pass));
                if (work > 0 || count == 0) {
                    run_pass(pass, first, 0, work);
                }
            }
        }
        for (CompiledPass &pass : passes) {
            carry_film(pass);
            if (pass.features.has(Feature::convergence) && (count == 0 || convergence->rule().is_check(first + count))) {
                convergence->check(pass.film, first + count);
                pass.stages.bind(convergence->arguments());
            }
            collect_profile(pass);
        }
    }

    void carry_film(CompiledPass &pass) {
        enqueue(pass, "carry_film");
        pass.additions = 0;
    }

    void collect_profile(CompiledPass &pass) {
        device.finish();
        for (const auto &[name, stage] : device.profiler().take()) {
            pass.profile[name].seconds += stage.seconds;
            pass.profile[name].launches += stage.launches;
        }
    }

    /// Traces the paths from `begin` to `end` of the batch that starts at sample `first`.
    void run_pass(CompiledPass &pass, uint64_t first, uint32_t begin, uint32_t end) {
        pass.stages.bind(
            {{StageInput::first_sample, {first}}, {StageInput::first_work, {begin}}, {StageInput::work, {end}}});
        if (!pass.streams) {
            enqueue(pass, pass.round.front().name, std::max<uint64_t>(end - begin, 1));  // 1: the first enqueue compiles
            return collect_profile(pass);
        }
        enqueue(pass, "reset_streams");
        const auto splat_stages = std::count_if(pass.round.begin(), pass.round.end(),
                                                [](const RoundStage &stage) { return stage.name == "splat_unblocked"; });
        uint64_t in_flight = layout.capacity;
        // The counters are read one check behind, so that the device is never idle while the host looks.
        std::array<StreamCounters, 2> seen{};
        std::array<ClEvent, 2> read;
        for (int check = 0;; ++check) {
            for (int i = 0; i < rounds_per_check; ++i) {
                for (const RoundStage &stage : pass.round) {
                    if (stage.rounds > 0 && static_cast<uint32_t>(check * rounds_per_check + i) >= stage.rounds) {
                        continue;
                    }
                    bind_chosen(pass, stage);
                    enqueue(pass, stage.name);
                }
            }
            // A camera path ends with one addition to its pixel, of which there are few in a batch; splats of all light
            // paths may go to one.
            pass.additions += static_cast<uint64_t>(splat_stages * rounds_per_check) * in_flight;
            if (pass.additions > FILM_ADDITIONS_BETWEEN_CARRIES) {
                carry_film(pass);
            }
            const int now = check % 2;
            cl_event event = nullptr;
            check_cl(clEnqueueReadBuffer(device.queue(), counters.get(), CL_FALSE, 0, sizeof(StreamCounters), &seen[now], 0,
                                         nullptr, &event),
                     "reading the stream counters");
            read[now] = ClEvent(event);
            check_cl(clFlush(device.queue()), "submitting work to the device");
            if (check > 0) {
                const int before = 1 - now;
                const cl_event wanted = read[before].get();
                check_cl(clWaitForEvents(1, &wanted), "waiting for the device");
                const StreamCounters &c = seen[before];
                if (c.overflow > 0) {
                    throw run_error(fmt::format("a stream overflowed {} times", c.overflow));
                }
                if (c.next_work >= end) {
                    in_flight = c.active[c.parity];
                }
                if (in_flight == 0) {
                    break;
                }
            }
        }
        collect_profile(pass);
    }

    void reset_film() {
        for (CompiledPass &pass : passes) {
            pass.clear();
            if (pass.features.has(Feature::convergence)) {
                convergence->reset();
                pass.stages.bind(convergence->arguments());
            }
        }
        counters.write({StreamCounters{}});
        ranges = FilmState();
        wall_seconds = 0;
        samples = 0;
    }

    double device_seconds() const {
        double seconds = pilot.seconds;
        for (const CompiledPass &pass : passes) {
            seconds += total_seconds(pass.profile);
        }
        return seconds;
    }

    /// Metadata of the film without its words.
    FilmState film_header() const {
        FilmState header = ranges;
        header.width = settings.width;
        header.height = settings.height;
        header.variance = settings.variance;
        header.passes.clear();
        for (const CompiledPass &pass : passes) {
            header.passes.push_back(pass.name);
            header.light_paths = pass.name == "light" ? numbers.light_paths : header.light_paths;
        }
        header.seed = numbers.seed;
        header.config = config;
        return header;
    }

    DeviceContext &device;
    RenderSettings settings;
    Pilot pilot;  ///< by which the number of light paths was chosen, if one was
    StreamLayout layout;
    IntegratorSettings numbers;
    CompiledScene compiled;
    FeatureMask features;  ///< of all passes
    std::vector<CompiledPass> passes;
    std::string scene_hash;
    std::string config;

    Bvh bvh;
    std::map<std::string, Profiler::Stage> bvh_stages;
    SceneBuffers scene_buffers;
    Buffer<uint32_t> path_words;
    Buffer<uint32_t> vertex_words;
    Buffer<uint32_t> branch_vertices;
    Buffer<uint32_t> queues;
    Buffer<StreamCounters> counters;
    std::unique_ptr<ConvergenceControl> convergence;  ///< of the camera pass, where pixels are stopped

    double compile_seconds = 0;
    double bvh_wall_seconds = 0;
    double wall_seconds = 0;
    uint64_t samples = 0;
    FilmState ranges;  ///< ranges, seconds and errors of films restored or rendered; no words
};

RenderSession::RenderSession(const Scene &scene, const RenderSettings &settings, DeviceContext &device)
    : state_(std::make_unique<State>(scene, settings, device)) {}
RenderSession::~RenderSession() = default;
RenderSession::RenderSession(RenderSession &&) noexcept = default;

uint64_t RenderSession::render(uint64_t begin, uint64_t end, const std::function<void(uint64_t)> &on_batch) {
    State &s = *state_;
    s.require_next(begin, end);
    while (begin < end && !interrupted()) {
        const uint64_t count = s.batch_size(begin, end);
        const uint64_t camera_paths = count * (s.convergence != nullptr ? s.convergence->live_count() : s.pixels());
        s.ranges.add_range({begin, begin + count});
        const auto start = Clock::now();
        s.run_batch(begin, count);
        s.wall_seconds += seconds_since(start);
        s.samples += camera_paths;
        begin += count;
        if (on_batch) {
            on_batch(begin);
        }
    }
    return begin;
}

bool RenderSession::is_complete() const { return state_->live_paths_per_sample() == 0; }

void RenderSession::restart(uint32_t seed) {
    state_->numbers.seed = state_->settings.seed = seed;
    for (CompiledPass &pass : state_->passes) {
        pass.stages.bind({{StageInput::settings, {pass.numbers(state_->numbers)}}});
    }
    state_->reset_film();
}

FilmState RenderSession::film() const {
    FilmState film = state_->film_header();
    for (const CompiledPass &pass : state_->passes) {
        const std::vector<int64_t> words = pass.film.read();
        film.words.insert(film.words.end(), words.begin(), words.end());
    }
    const StreamCounters counters = state_->counters.read().front();
    film.non_finite += counters.non_finite;
    film.out_of_range += counters.out_of_range;
    film.device_seconds += state_->device_seconds();
    film.wall_seconds += state_->wall_seconds;
    if (state_->convergence != nullptr) {
        film.convergence = state_->convergence->state();
    }
    return film;
}

void RenderSession::restore(const FilmState &film) {
    const FilmState header = state_->film_header();
    if (film.config != header.config || film.seed != header.seed || film.width != header.width ||
        film.height != header.height || film.variance != header.variance || film.passes != header.passes ||
        film.convergence.has_value() != (state_->convergence != nullptr)) {
        throw input_error("the film state belongs to another scene, other settings, another seed or size");
    }
    state_->reset_film();
    for (size_t pass = 0; pass < film.passes.size(); ++pass) {
        const auto first = film.words.begin() + static_cast<std::ptrdiff_t>(pass * state_->film_words());
        state_->passes[pass].film.write({first, first + static_cast<std::ptrdiff_t>(state_->film_words())});
    }
    if (state_->convergence != nullptr) {
        state_->convergence->restore(*film.convergence);
        state_->passes.front().stages.bind(state_->convergence->arguments());
    }
    state_->ranges = film;
    state_->ranges.words.clear();
    state_->ranges.convergence.reset();
}

Image RenderSession::develop() const {
    const FilmState state = film();
    require_valid(state);
    Image image = develop_film(state);
    describe_image(image, state);
    image.attributes()["rtrays:device"] = state_->device.info().name;
    image.attributes()["rtrays:driver"] = state_->device.info().platform_name + " " + state_->device.info().driver;
    image.attributes()["rtrays:buildOptions"] = std::string(program_options);
    image.attributes()["rtrays:sceneHash"] = state_->scene_hash;
    image.attributes()["rtrays:settings"] = image_settings(state_->settings).dump();
    return image;
}

RenderStats RenderSession::stats() const {
    RenderStats stats;
    stats.compile_seconds = state_->compile_seconds;
    stats.bvh_seconds = state_->bvh.report().seconds_device;
    stats.device_seconds = state_->device_seconds();
    stats.wall_seconds = state_->wall_seconds;
    stats.samples = state_->samples;
    const StreamCounters counters = state_->counters.read().front();
    stats.rays = counters.nearest_rays + counters.shadow_rays;
    return stats;
}

nlohmann::json RenderSession::report() const {
    const State &s = *state_;
    const RenderStats numbers = stats();
    const StreamCounters counters = s.counters.read().front();
    nlohmann::json report = {
        {"schema_version", 1},
        {"commit", RTRAYS_COMMIT},
        {"dirty", RTRAYS_DIRTY},
        {"device", {{"name", s.device.info().name}, {"driver", s.device.info().driver}, {"platform", s.device.info().platform_name}}},
        {"settings", image_settings(s.settings)},
        {"features", s.features.names()},
        {"pipeline", s.settings.pipeline},
        {"stream",
         {{"group_size", s.layout.group_size},
          {"capacity", s.layout.capacity},
          {"chunk", s.layout.chunk},
          {"interleaved", s.layout.interleaved}}},
        {"scene", {{"hash", s.scene_hash}, {"triangles", s.compiled.surface_triangles.size()}, {"lights", s.compiled.lights.size()}}},
        {"seconds",
         {{"compile", numbers.compile_seconds},
          {"bvh_device", numbers.bvh_seconds},
          {"bvh_wall", s.bvh_wall_seconds},
          {"device", numbers.device_seconds},
          {"wall", numbers.wall_seconds}}},
        {"samples", numbers.samples},
        {"rays", {{"nearest", counters.nearest_rays}, {"shadow", counters.shadow_rays}}},
        {"rounds", counters.iterations},
    };
    for (const PilotTrial &trial : s.pilot.trials) {
        report["pilot"]["trials"].push_back(
            {{"light_paths_per_pixel", trial.per_pixel}, {"variance", trial.variance}, {"rays_per_pixel", trial.rays}});
    }
    if (!s.pilot.trials.empty()) {
        report["pilot"].update({{"light_paths", s.pilot.light_paths}, {"seconds", s.pilot.seconds}});
    }
    uint32_t largest_path = 0;
    for (const CompiledPass &pass : s.passes) {
        const auto add_programs = [&](const std::map<std::string, Program> &programs) {
            for (const auto &[file, program] : programs) {
                report["programs"].push_back({{"pass", pass.name},
                                              {"file", file},
                                              {"seconds", program.build_seconds()},
                                              {"from_cache", program.from_cache()},
                                              {"binary_bytes", program.binary_bytes()}});
            }
        };
        add_programs(pass.stages.programs());
        if (pass.features.has(Feature::convergence)) {
            add_programs(s.convergence->programs());
        }
        for (const auto &[name, stage] : pass.profile) {
            report["stages"].push_back(
                {{"pass", pass.name}, {"name", name}, {"seconds", stage.seconds}, {"launches", stage.launches}});
        }
        uint32_t path_bytes = pass.streams ? STREAM_QUEUES * sizeof(uint32_t) : 0;
        nlohmann::json fields;
        for (const PathStateField &field : path_state_fields(pass.features)) {
            fields.push_back({{"field", field.name}, {"bytes", field.words * sizeof(uint32_t)}});
            path_bytes += field.words * static_cast<uint32_t>(sizeof(uint32_t));
        }
        report["passes"].push_back({{"name", pass.name},
                                    {"features", pass.features.names()},
                                    {"paths_per_sample", s.paths_per_sample(pass)},
                                    {"path_state", fields},
                                    {"bytes_per_path", path_bytes}});
        if (pass.ray_counts.size() > 0) {
            report["passes"].back()["rays_by_depth"] = {{"nearest", pass.rays_by_depth(RAY_NEAREST)},
                                                        {"shadow", pass.rays_by_depth(RAY_SHADOW)}};
        }
        largest_path = std::max(largest_path, path_bytes);
    }
    // In memory: the passes take turns, but for the light vertices that one keeps for the other.
    const uint32_t vertex_bytes = s.vertex_words_per_path() * static_cast<uint32_t>(sizeof(uint32_t));
    const uint32_t branch_bytes = s.branch_words_per_path() * static_cast<uint32_t>(sizeof(uint32_t));
    report["light_vertex_bytes_per_path"] = vertex_bytes;
    report["branch_bytes_per_path"] = branch_bytes;
    report["bytes_per_path"] = largest_path + vertex_bytes + branch_bytes;
    for (const auto &[name, stage] : s.bvh_stages) {
        report["bvh"]["stages"].push_back({{"name", name}, {"seconds", stage.seconds}, {"launches", stage.launches}});
    }
    const BvhReport &bvh = s.bvh.report();
    report["bvh"].update({{"layout", to_string(s.layout.bvh)}, {"nodes", bvh.nodes}, {"leaves", bvh.leaves}, {"depth", bvh.depth}, {"sah_cost", bvh.sah_cost},
                          {"wide_nodes", bvh.wide_nodes}, {"wide_leaves", bvh.wide_leaves}, {"rejected", bvh.rejected()}, {"bytes", bvh.bytes}, {"bytes_peak", bvh.bytes_peak}});
    const auto add_buffer = [&](const auto &buffer) {
        if (buffer.size() > 0) {
            report["buffers"].push_back({{"name", buffer.name()}, {"bytes", buffer.bytes()}});
        }
    };
    s.bvh.visit([&](const auto &nodes, const auto &triangles) {
        add_buffer(nodes);
        add_buffer(triangles);
    });
    s.scene_buffers.visit(add_buffer);
    add_buffer(s.path_words);
    add_buffer(s.vertex_words);
    add_buffer(s.branch_vertices);
    add_buffer(s.queues);
    add_buffer(s.counters);
    for (const CompiledPass &pass : s.passes) {
        add_buffer(pass.film);
        add_buffer(pass.ray_counts);
    }
    if (s.convergence != nullptr) {
        s.convergence->visit_buffers(add_buffer);
        report["convergence"] = convergence_report(s.convergence->state(), s.ranges.samples());
    }
    return report;
}

void describe_image(Image &image, const FilmState &film) {
    std::string ranges;
    for (const SampleRange &range : film.ranges) {
        ranges += fmt::format("{}{}:{}", ranges.empty() ? "" : " ", range.begin, range.end);
    }
    auto &attributes = image.attributes();
    attributes["samplesPerPixel"] = static_cast<int>(film.samples());
    attributes["renderTimeSeconds"] = static_cast<float>(film.wall_seconds);
    attributes["rtrays:deviceSeconds"] = film.device_seconds;
    attributes["rtrays:commit"] = std::string(RTRAYS_VERSION);
    attributes["rtrays:seed"] = std::to_string(film.seed);
    attributes["rtrays:samples"] = ranges;
    attributes["rtrays:config"] = film.config;
    if (film.convergence) {
        attributes["rtrays:convergence"] = film.convergence->rule.describe();
    }
}

}  // namespace rtrays
