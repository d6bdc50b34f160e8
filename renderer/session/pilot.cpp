// SPDX-License-Identifier: MIT
#include "renderer/session/pilot.h"

#include <algorithm>
#include <cmath>

#include "renderer/compile/device_scene.h"
#include "renderer/integrators/unseen_light.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {

namespace {

constexpr uint64_t pilot_samples = 16;
constexpr double pilot_pixels = 128 * 128;
constexpr double most_per_pixel = 256;
/// A trial must cost less than this fraction of the one before; otherwise further trials cost more
/// than they gain.
constexpr double worth_going_on = 0.9;

/// Renders one setting, sample by sample, and estimates its variance from the scatter of
/// independent parts: of the samples, or of the sums of each Sobol sequence. Adds the times to
/// those of `pilot`.
PilotTrial attempt(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                   const RenderSettings &settings, Pilot &pilot) {
    RenderSession session(shared, scene, settings);
    PilotTrial trial;
    const uint64_t parts = settings.sampler == Sampler::sobol ? SOBOL_SEQUENCES : pilot_samples;
    std::vector<std::vector<double>> sums(parts);
    for (uint64_t sample = 0; sample < pilot_samples; ++sample) {
        session.restart(settings.seed);
        session.render(sample, sample + 1);
        trial.rays += static_cast<double>(session.stats().rays);
        pilot.seconds += session.stats().device_seconds;
        pilot.wall_seconds += session.stats().wall_seconds;
        const Image image = session.develop();
        std::vector<double> &part = sums[sample % parts];
        part.resize(3 * image.pixel_count());
        size_t i = 0;
        for (const std::string &name : rgb_names()) {
            for (const float value : image.channel(name)) {
                part[i++] += static_cast<double>(value);
            }
        }
    }
    const auto n = static_cast<double>(parts);
    const size_t values = sums.front().size();
    for (size_t i = 0; i < values; ++i) {
        double sum = 0, squares = 0;
        for (const std::vector<double> &part : sums) {
            sum += part[i];
            squares += part[i] * part[i];
        }
        trial.variance += std::max(squares - sum * sum / n, 0.0) / (n - 1);
    }
    // The variance of a part's sum, per sample.
    trial.variance /= static_cast<double>(values) * (static_cast<double>(pilot_samples) / n);
    trial.rays /= static_cast<double>(pilot_samples) * static_cast<double>(values) / 3;
    return trial;
}

}  // namespace

Pilot choose_light_paths(const std::shared_ptr<DeviceScene> &shared, const Scene &scene,
                         const RenderSettings &settings) {
    RenderSettings small = settings;
    small.seed = ~settings.seed;
    small.only_pass.reset();
    small.variance = small.separate_strategies = false;
    small.convergence_error = 0;
    const double pixels = static_cast<double>(settings.width) * settings.height;
    const double shrink = std::min(1.0, std::sqrt(pilot_pixels / pixels));
    small.width = std::max(1, static_cast<int>(settings.width * shrink));
    small.height = std::max(1, static_cast<int>(settings.height * shrink));
    if (settings.window.full_width > 0) {
        // The same part of a smaller picture.
        const auto scaled = [](int size, int from, int to) {
            return static_cast<int>(static_cast<int64_t>(size) * to / from);
        };
        RenderSettings::Window &window = small.window;
        window.full_width = scaled(window.full_width, settings.width, small.width);
        window.full_height = scaled(window.full_height, settings.height, small.height);
        window.x = std::min(scaled(window.x, settings.width, small.width),
                            window.full_width - small.width);
        window.y = std::min(scaled(window.y, settings.height, small.height),
                            window.full_height - small.height);
    }
    const double small_pixels = static_cast<double>(small.width) * small.height;

    Pilot pilot;
    const auto paths_of = [](double per_pixel, double of_pixels) {
        return static_cast<uint32_t>(std::lround(per_pixel * of_pixels));
    };
    const auto cost = [](const PilotTrial &trial) { return trial.variance * trial.rays; };
    const auto best = [&] {
        return *std::min_element(
            pilot.trials.begin(), pilot.trials.end(),
            [&](const PilotTrial &a, const PilotTrial &b) { return cost(a) < cost(b); });
    };
    const auto add_trial = [&](double per_pixel) {
        small.light_paths = paths_of(per_pixel, small_pixels);
        pilot.trials.push_back(attempt(shared, scene, small, pilot));
        pilot.trials.back().per_pixel = per_pixel;
    };
    // Without light paths, caustics that only they find would be missing without any variance.
    const bool needs_light_paths =
        shared->compiled().lighting.light_count > 0 &&
        !unseen_light(algorithms::path_tracing, scene.arrays(), settings.max_depth).empty();
    for (const double per_pixel : {0.0, 0.25, 1.0, 4.0}) {
        if (per_pixel > 0 || !needs_light_paths) {
            add_trial(per_pixel);
        }
    }
    const auto pays = [&] {
        const auto last = pilot.trials.rbegin();
        return cost(*last) < worth_going_on * cost(*(last + 1)) &&
               best().per_pixel == last->per_pixel;
    };
    while (pays() && pilot.trials.back().per_pixel < most_per_pixel) {
        add_trial(4 * pilot.trials.back().per_pixel);
    }
    pilot.light_paths = paths_of(best().per_pixel, pixels);
    return pilot;
}

}  // namespace rtrays
