// SPDX-License-Identifier: MIT
#include "renderer/session/pilot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "renderer/compile/device_scene.h"
#include "renderer/compile/emission_guide.h"
#include "renderer/integrators/unseen_light.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"
#include "renderer/session/state.h"

namespace rtrays {

namespace {

using ByTrial = std::array<double, LIGHT_PATH_TRIALS>;

// Costs in units of the time of a ray in path tracing (results/chapter4, stages of the curves).
/// Start of a light path.
constexpr double start_cost = 1.1;
/// Factor of the cost of camera paths that are weighted against light paths.
constexpr double weighting_cost = 1.2;

/// Light paths per pixel with whose weights the first guide is trained, before their number is
/// chosen.
constexpr double first_guide_paths = 0.25;

/// Returns the number of light paths per pixel in a trial.
double paths_per_pixel(size_t trial) {
    return trial == 0 ? 0.0 : std::exp2(trial_log_factor(static_cast<uint32_t>(trial)));
}

/// Returns the trial with light paths that is nearest to a number of them per pixel.
size_t nearest_trial(double per_pixel) {
    size_t nearest = 1;
    for (size_t trial = 2; trial < LIGHT_PATH_TRIALS; ++trial) {
        // The numbers are powers of 4, so that the middle of two is half of the greater.
        nearest = per_pixel > paths_per_pixel(trial) / 2 ? trial : nearest;
    }
    return nearest;
}

/// Returns the variance of one sample of a pixel, mean over the pixels. The two samples of a pixel
/// are neighbours in `paths`.
ByTrial camera_variance(const std::vector<PathTrials> &paths) {
    ByTrial sums{};
    for (size_t i = 0; i + 1 < paths.size(); i += 2) {
        for (size_t trial = 0; trial < sums.size(); ++trial) {
            const double difference = static_cast<double>(paths[i].value[trial]) -
                                      static_cast<double>(paths[i + 1].value[trial]);
            sums[trial] += difference * difference / 2;
        }
    }
    for (double &sum : sums) {
        sum /= static_cast<double>(paths.size()) / 2;
    }
    return sums;
}

/// Returns the variance of the light paths of one sample of the image, mean over its pixels.
ByTrial light_variance(const std::vector<PathTrials> &paths) {
    ByTrial sums{};
    for (const PathTrials &path : paths) {
        for (size_t trial = 0; trial < sums.size(); ++trial) {
            const auto value = static_cast<double>(path.value[trial]);
            sums[trial] += value * value;
        }
    }
    for (size_t trial = 0; trial < sums.size(); ++trial) {
        sums[trial] *= paths_per_pixel(trial) / static_cast<double>(paths.size());
    }
    return sums;
}

/// Traces the paths of one pass and adds the times to those of `pilot`.
TrialPaths trace(RenderSession &session, PassKind pass, Pilot &pilot) {
    const RenderStats before = session.stats();
    TrialPaths found = session.trace_trials(pass);
    pilot.seconds += session.stats().device_seconds - before.device_seconds;
    pilot.wall_seconds += session.stats().wall_seconds - before.wall_seconds;
    return found;
}

/// Fills the trials, without 0 if only light paths see some light, and chooses the number of light
/// paths.
void choose_light_paths(Pilot &pilot, const TrialPaths &camera, const TrialPaths &light,
                        const Scene &scene, const RenderSettings &settings) {
    const ByTrial of_camera = camera_variance(camera.paths);
    const ByTrial of_light = light_variance(light.paths);
    const auto count = static_cast<double>(camera.paths.size());
    for (size_t trial = 0; trial < LIGHT_PATH_TRIALS; ++trial) {
        const double per_pixel = paths_per_pixel(trial);
        pilot.trials.push_back({per_pixel, of_camera[trial] + of_light[trial],
                                camera.rays / count * (trial == 0 ? 1.0 : weighting_cost) +
                                    per_pixel * (light.rays / count + start_cost)});
    }
    // Without light paths, caustics that only they find would be missing without any variance.
    if (!unseen_light(algorithms::path_tracing, scene.arrays(), settings.max_depth).empty()) {
        pilot.trials.erase(pilot.trials.begin());
    }
    const PilotTrial best = *std::min_element(pilot.trials.begin(), pilot.trials.end(),
                                              [](const PilotTrial &a, const PilotTrial &b) {
                                                  return a.variance * a.cost < b.variance * b.cost;
                                              });
    pilot.light_paths = static_cast<uint32_t>(
        std::lround(best.per_pixel * static_cast<double>(settings.width) * settings.height));
}

}  // namespace

TrialPaths RenderSession::trace_trials(PassKind kind) {
    State &s = *state_;
    const auto pass = std::find_if(s.passes.begin(), s.passes.end(),
                                   [&](const CompiledPass &p) { return p.kind == kind; });
    s.counters.clear();
    const auto start = SteadyClock::now();
    TrialPaths found;
    found.paths.resize(2 * s.trial_pixels.size());
    s.run_pass(*pass, 0, 0, static_cast<uint32_t>(found.paths.size()));
    const std::vector<int64_t> words = pass->film.read();
    std::memcpy(found.paths.data(), words.data(), pass->film.bytes());
    s.wall_seconds += seconds_since(start);
    found.rays = static_cast<double>(stats().rays);
    return found;
}

bool trains_guide(const RenderSettings &settings) {
    return settings.guided_emission == GuidedEmission::trained &&
           settings.emission_guide == nullptr;
}

bool needs_pilot(const RenderSettings &settings) {
    return settings.light_paths == LIGHT_PATHS_AUTO || trains_guide(settings);
}

RenderSettings pilot_settings(const RenderSettings &settings) {
    RenderSettings pilot = settings;
    pilot.seed = ~settings.seed;
    pilot.light_paths = LIGHT_PATHS_LIKE_PIXELS;
    pilot.light_path_trials = true;
    pilot.only_pass.reset();
    if (settings.light_paths != LIGHT_PATHS_AUTO) {
        pilot.only_pass = PassKind::light;
    }
    if (trains_guide(settings)) {
        pilot.guided_emission = GuidedEmission::flat;
    }
    pilot.variance = pilot.separate_strategies = false;
    pilot.convergence_error = 0;
    return pilot;
}

Pilot run_pilot(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                const RenderSettings &settings) {
    const CompiledScene &compiled = shared->compiled();
    const bool trains = trains_guide(settings), chooses = settings.light_paths == LIGHT_PATHS_AUTO;
    if (trains) {
        require_trainable(compiled);
    }
    Pilot pilot;
    pilot.light_paths = chooses ? 0 : light_paths_per_sample(settings);
    if (compiled.lighting.light_count == 0) {
        return pilot;
    }
    const double pixels = static_cast<double>(settings.width) * settings.height;
    RenderSettings own = pilot_settings(settings);
    std::vector<PathTrials> training;
    const auto guide = [&](double light_paths) {
        return std::make_shared<const EmissionGuide>(make_guide(
            compiled, emission_moments(compiled, training, nearest_trial(light_paths / pixels))));
    };
    if (trains) {
        RenderSettings flat = own;
        flat.only_pass = PassKind::light;
        RenderSession session(shared, scene, flat);
        training = trace(session, PassKind::light, pilot).paths;
        own.guided_emission = GuidedEmission::off;
        own.emission_guide = guide(chooses ? first_guide_paths * pixels : pilot.light_paths);
        own.seed ^= 1u << 31;  // other paths
    }
    RenderSession session(shared, scene, own);
    const TrialPaths light = trace(session, PassKind::light, pilot);
    if (chooses) {
        choose_light_paths(pilot, trace(session, PassKind::camera, pilot), light, scene, settings);
    }
    if (trains && pilot.light_paths > 0) {
        training.insert(training.end(), light.paths.begin(), light.paths.end());
        pilot.guide = guide(pilot.light_paths);
    }
    return pilot;
}

}  // namespace rtrays
