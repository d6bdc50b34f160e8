// SPDX-License-Identifier: MIT
#include "renderer/session/render_session.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "renderer/base/commit.h"
#include "renderer/base/error.h"
#include "renderer/base/progress.h"
#include "renderer/integrators/unseen_light.h"
#include "renderer/session/state.h"

namespace rtrays {

RenderSession::RenderSession(const Scene &scene, const RenderSettings &settings,
                             DeviceContext &device)
    : RenderSession(std::make_shared<DeviceScene>(
                        scene, device_scene_settings(settings, device.info()), device),
                    scene, settings) {}
RenderSession::RenderSession(std::shared_ptr<DeviceScene> shared, const Scene &scene,
                             const RenderSettings &settings)
    : state_(std::make_unique<State>(std::move(shared), scene, settings)) {}
RenderSession::~RenderSession() = default;
RenderSession::RenderSession(RenderSession &&) noexcept = default;

uint64_t RenderSession::render(uint64_t begin, uint64_t end,
                               const std::function<void(uint64_t)> &on_batch) {
    State &s = *state_;
    s.require_current();
    s.require_next(begin, end);
    while (begin < end && !interrupted()) {
        const uint64_t count = s.batch_size(begin, end);
        const uint64_t camera_paths =
            count * (s.convergence != nullptr ? s.convergence->live_count() : s.pixels());
        s.ranges.add_range({begin, begin + count});
        const auto start = SteadyClock::now();
        const double compiled_before = s.compile_seconds;
        s.run_batch(begin, count);
        s.wall_seconds += seconds_since(start) - (s.compile_seconds - compiled_before);
        s.samples += camera_paths;
        begin += count;
        if (on_batch) {
            on_batch(begin);
        }
    }
    return begin;
}

const RenderSettings &RenderSession::settings() const {
    return state_->settings;
}

bool RenderSession::is_complete() const {
    return state_->live_paths_per_sample() == 0;
}

void RenderSession::restart(uint32_t seed) {
    state_->integrator.seed = state_->settings.seed = seed;
    for (CompiledPass &pass : state_->passes) {
        pass.stages.bind({{StageInput::settings, {state_->settings_of(pass)}}});
    }
    state_->reset_film();
}

void RenderSession::restart(uint32_t seed, uint32_t max_depth) {
    if (state_->settings.max_depth == 0 || max_depth == 0 ||
        state_->settings.algorithm->fixed_depth > 0 || state_->features.has(Feature::branches)) {
        throw input_error(
            fmt::format("{}: integrator.max_depth={} cannot become {}; start a new session",
                        state_->settings.algorithm->name, state_->settings.max_depth, max_depth));
    }
    state_->integrator.max_depth = state_->settings.max_depth = max_depth;
    state_->set_config();
    restart(seed);
}

void RenderSession::update(const Scene &scene) {
    if (!state_->update(scene)) {
        // The settings have the choices of the pilot. A guide is trained again, and explicit paths
        // return with lights that no path hits.
        Pilot former = state_->pilot;
        RenderSettings settings = state_->settings;
        if (!former.is_explicit && !lights_not_hit(scene.arrays()).empty()) {
            settings.strategies = PathStrategies::mis;
            former.is_explicit = true;
        }
        if (settings.guided_emission == GuidedEmission::trained) {
            settings.emission_guide = nullptr;
        }
        if (settings.guided_scattering == GuidedScattering::trained) {
            settings.scatter_guide = nullptr;
        }
        state_ = std::make_unique<State>(state_->scene, scene, settings);
        if (state_->pilot.rays > 0) {
            state_->pilot.trials = former.trials;
        } else {
            state_->pilot = former;
        }
    }
}

void RenderSession::resize(int width, int height) {
    state_->resize(width, height);
}

FilmState RenderSession::film() const {
    FilmState film = state_->film_header();
    for (CompiledPass &pass : state_->passes) {
        const std::vector<int64_t> words = state_->read_film(pass);
        film.words.insert(film.words.end(), words.begin(), words.end());
    }
    const StreamCounters counters = state_->counters.read().front();
    film.non_finite += counters.non_finite;
    film.out_of_range += counters.out_of_range;
    film.device_seconds += state_->device_seconds();
    film.wall_seconds += state_->wall_seconds + state_->pilot.wall_seconds;
    if (state_->convergence != nullptr) {
        film.convergence = state_->convergence->state();
    }
    return film;
}

void RenderSession::restore(const FilmState &film) {
    if (const auto difference = find_difference(film, state_->film_header())) {
        throw input_error(fmt::format(
            "the film was rendered with {0} = {1}, and this render has {2}; resume with "
            "the {0} of the film",
            difference->name, difference->first, difference->second));
    }
    state_->reset_film();
    for (size_t pass = 0; pass < film.passes.size(); ++pass) {
        const auto first =
            film.words.begin() + static_cast<std::ptrdiff_t>(pass * state_->film_words());
        state_->passes[pass].film.write(
            {first, first + static_cast<std::ptrdiff_t>(state_->film_words())});
    }
    if (state_->convergence != nullptr) {
        state_->convergence->restore(*film.convergence);
        state_->passes.front().stages.bind(state_->convergence->arguments());
    }
    state_->ranges = film;
    state_->ranges.words.clear();
    state_->ranges.convergence.reset();
}

Image RenderSession::develop(const FilmState &state) const {
    require_valid(state);
    Image image = develop_film(state);
    describe_image(image, state);
    image.attributes()["rtrays:device"] = state_->device.info().name;
    image.attributes()["rtrays:driver"] =
        state_->device.info().platform_name + " " + state_->device.info().driver;
    image.attributes()["rtrays:buildOptions"] = program_options(state_->device.info());
    image.attributes()["rtrays:sceneHash"] = state_->scene->hash();
    image.attributes()["rtrays:settings"] = image_settings(state_->settings).dump();
    return image;
}

RenderStats RenderSession::stats() const {
    RenderStats stats;
    stats.compile_seconds = state_->compile_seconds;
    stats.bvh_seconds = state_->scene->bvh().report().seconds_device;
    stats.device_seconds = state_->device_seconds();
    stats.wall_seconds = state_->wall_seconds + state_->pilot.wall_seconds;
    stats.samples = state_->samples;
    const StreamCounters counters = state_->counters.read().front();
    stats.rays = counters.nearest_rays + counters.shadow_rays + state_->pilot.rays;
    return stats;
}

void describe_image(Image &image, const FilmState &film) {
    auto &attributes = image.attributes();
    attributes["samplesPerPixel"] = static_cast<int>(film.samples());
    attributes["renderTimeSeconds"] = static_cast<float>(film.wall_seconds);
    attributes["rtrays:deviceSeconds"] = film.device_seconds;
    attributes["rtrays:commit"] = version();
    attributes["rtrays:seed"] = std::to_string(film.seed);
    attributes["rtrays:samples"] = describe(film.ranges);
    attributes["rtrays:config"] = film.config_hash();
    if (film.sequences) {
        attributes["rtrays:varianceFreedom"] = static_cast<int>(SOBOL_SEQUENCES) - 1;
    }
    if (film.convergence) {
        attributes["rtrays:convergence"] = film.convergence->rule.describe();
    }
}

}  // namespace rtrays
