// SPDX-License-Identifier: MIT
#include "renderer/session/pilot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "renderer/compile/device_scene.h"
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

/// Returns the number of light paths per pixel in a trial.
double paths_per_pixel(size_t trial) {
    return trial == 0 ? 0.0 : std::exp2(trial_log_factor(static_cast<uint32_t>(trial)));
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
            sums[trial] += static_cast<double>(path.value[trial]);
        }
    }
    for (size_t trial = 0; trial < sums.size(); ++trial) {
        sums[trial] *= paths_per_pixel(trial) / static_cast<double>(paths.size());
    }
    return sums;
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

RenderSettings pilot_settings(const RenderSettings &settings) {
    RenderSettings pilot = settings;
    pilot.seed = ~settings.seed;
    pilot.light_paths = LIGHT_PATHS_LIKE_PIXELS;
    pilot.light_path_trials = true;
    pilot.only_pass.reset();
    pilot.variance = pilot.separate_strategies = false;
    pilot.convergence_error = 0;
    return pilot;
}

Pilot choose_light_paths(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                         const RenderSettings &settings) {
    if (shared->compiled().lighting.light_count == 0) {
        return {};
    }
    RenderSession session(shared, scene, pilot_settings(settings));
    const TrialPaths camera = session.trace_trials(PassKind::camera);
    const ByTrial of_camera = camera_variance(camera.paths);

    const TrialPaths light = session.trace_trials(PassKind::light);
    const ByTrial of_light = light_variance(light.paths);

    Pilot pilot;
    pilot.seconds = session.stats().device_seconds;
    pilot.wall_seconds = session.stats().wall_seconds;
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
    const double pixels = static_cast<double>(settings.width) * settings.height;
    pilot.light_paths = static_cast<uint32_t>(std::lround(best.per_pixel * pixels));
    return pilot;
}

}  // namespace rtrays
