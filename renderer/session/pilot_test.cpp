// SPDX-License-Identifier: MIT
// Tests the number of light paths that a pilot rendering chooses.
#include "renderer/session/pilot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

#include <nlohmann/json.hpp>

#include "renderer/compile/device_scene.h"
#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

DeviceContext &device() {
    static DeviceContext context;
    return context;
}

RenderSettings settings_of(uint32_t light_paths, const std::string &algorithm = "truncated_bdpt") {
    RenderSettings settings;
    settings.algorithm = &algorithm_named(algorithm);
    settings.width = settings.height = 32;
    settings.stream_capacity = 512;
    settings.light_paths = light_paths;
    return settings;
}

std::vector<int64_t> render_words(const std::string &scene, const RenderSettings &settings) {
    RenderSession session(load_scene(RTRAYS_SCENES + scene), settings, device());
    session.render(0, 2);
    return session.film().words;
}

Pilot choose(const Scene &scene, const RenderSettings &settings) {
    const auto shared = std::make_shared<DeviceScene>(
        scene, device_scene_settings(settings, device().info()), device());
    return run_pilot(shared, scene, settings);
}

TEST(Pilot, ChoosesTheLeastVarianceTimesRays) {
    const auto chosen = [](const std::string &scene) {
        const Pilot pilot =
            choose(load_scene(RTRAYS_SCENES + scene), settings_of(LIGHT_PATHS_AUTO));
        const bool is_hit = scene != "/features/point_light.json";
        EXPECT_EQ(pilot.trials.size(), is_hit ? LIGHT_PATH_TRIALS : LIGHT_PATH_NUMBERS);
        double least = std::numeric_limits<double>::infinity();
        for (const PilotTrial &trial : pilot.trials) {
            EXPECT_GT(trial.variance, 0);
            EXPECT_GT(trial.cost, 1);
            least = std::min(least, trial.variance * trial.cost);
        }
        const auto is_equal = [&](const PilotTrial &trial) {
            return 0.95 * trial.variance * trial.cost <= least;
        };
        for (const PilotTrial &trial : pilot.trials) {
            const bool is_chosen =
                pilot.light_paths == static_cast<uint32_t>(trial.per_pixel * 32 * 32) &&
                pilot.is_explicit == trial.is_explicit;
            EXPECT_TRUE(is_equal(trial) || !is_chosen) << scene << ": chosen, but less efficient";
            if (is_chosen) {
                for (const PilotTrial &other : pilot.trials) {
                    EXPECT_TRUE(other.cost >= trial.cost || !is_equal(other))
                        << scene << ": a cheaper one is as efficient";
                }
            }
        }
        EXPECT_GT(pilot.seconds, 0);
        EXPECT_GT(pilot.wall_seconds, 0);
        return pilot.light_paths;
    };
    // Light paths are efficient for caustics of mirrors, but not for diffuse surfaces under a point
    // light.
    EXPECT_GT(chosen("/cornell_mirrors/scene.json"), 0u);
    EXPECT_EQ(chosen("/features/point_light.json"), 0u);
}

/// A mean with its standard error.
struct Estimate {
    explicit Estimate(const std::vector<double> &values) {
        const auto n = static_cast<double>(values.size());
        mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
        double scatter = 0;
        for (const double value : values) {
            scatter += (value - mean) * (value - mean);
        }
        error = std::sqrt(scatter / (n - 1) / n);
    }
    double mean, error;
};

/// Returns the mean over pixels of the variance of `samples` samples' mean luminance, times that
/// number, from 8 batches of 8 renders.
Estimate rendered_variance(const Scene &scene, RenderSettings settings, uint32_t samples = 1) {
    settings.stream_capacity = 0;  // the device's, which takes less time
    const int renders = 8;
    RenderSession session(scene, settings, device());
    std::vector<double> variances;
    for (uint32_t batch = 0; batch < 8; ++batch) {
        std::vector<double> sums(32 * 32), squares(sums.size());
        for (uint32_t i = 0; i < renders; ++i) {
            session.restart(batch * renders + i);
            session.render(0, samples);
            const Image image = session.develop();
            for (size_t pixel = 0; pixel < sums.size(); ++pixel) {
                const double luminance = 0.2126 * static_cast<double>(image.channel("R")[pixel]) +
                                         0.7152 * static_cast<double>(image.channel("G")[pixel]) +
                                         0.0722 * static_cast<double>(image.channel("B")[pixel]);
                sums[pixel] += luminance;
                squares[pixel] += luminance * luminance;
            }
        }
        double variance = 0;
        for (size_t pixel = 0; pixel < sums.size(); ++pixel) {
            variance +=
                samples * (squares[pixel] - sums[pixel] * sums[pixel] / renders) / (renders - 1);
        }
        variances.push_back(variance / static_cast<double>(sums.size()));
    }
    return Estimate(variances);
}

/// Returns the variances of the trials of some pilots, by number of light paths per pixel and
/// whether there are explicit paths.
std::map<std::pair<double, bool>, std::vector<double>> pilot_variances(const Scene &scene,
                                                                       Sampler sampler,
                                                                       uint32_t pilots) {
    std::map<std::pair<double, bool>, std::vector<double>> variances;
    for (uint32_t seed = 0; seed < pilots; ++seed) {
        RenderSettings settings = settings_of(LIGHT_PATHS_AUTO);
        settings.sampler = sampler;
        settings.seed = seed;
        for (const PilotTrial &trial : choose(scene, settings).trials) {
            variances[{trial.per_pixel, trial.is_explicit}].push_back(trial.variance);
        }
    }
    return variances;
}

// The estimates of all trials come from paths of one of them.
TEST(Pilot, EstimatesTheVarianceOfEveryNumberOfLightPaths) {
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    const auto of_pilots = pilot_variances(scene, Sampler::independent, 8);
    for (const auto &[per_pixel, is_explicit] : {std::pair(0.25, true), std::pair(4.0, false)}) {
        RenderSettings settings = settings_of(static_cast<uint32_t>(per_pixel * 32 * 32));
        settings.strategies = is_explicit ? PathStrategies::mis : PathStrategies::implicit_only;
        const Estimate pilots(of_pilots.at({per_pixel, is_explicit})),
            rendered = rendered_variance(scene, settings);
        EXPECT_NEAR(pilots.mean, rendered.mean, 4 * std::hypot(pilots.error, rendered.error))
            << per_pixel << " " << is_explicit;
        EXPECT_LT(rendered.error, 0.15 * rendered.mean) << per_pixel << " " << is_explicit;
        EXPECT_LT(pilots.error, 0.15 * pilots.mean) << per_pixel << " " << is_explicit;
    }
}

// Two sequences say less about the variance of a pixel than eight samples. The camera of this scene
// sees no emitter.
TEST(Pilot, EstimatesTheVarianceOfSobolPoints) {
    const Scene scene = load_scene(RTRAYS_SCENES "/features/area_light.json");
    RenderSettings settings = settings_of(0);
    const Estimate independent = rendered_variance(scene, settings);
    settings.sampler = Sampler::sobol;
    const Estimate pilots(pilot_variances(scene, Sampler::sobol, 32).at({0.0, true})),
        rendered = rendered_variance(scene, settings, TRIAL_SAMPLES);
    EXPECT_NEAR(pilots.mean, rendered.mean, 4 * std::hypot(pilots.error, rendered.error));
    EXPECT_LT(rendered.error, 0.05 * rendered.mean);
    EXPECT_LT(pilots.error, 0.05 * pilots.mean);
    EXPECT_LT(pilots.mean + 4 * std::hypot(pilots.error, independent.error), independent.mean)
        << "as large as that of independent samples";
}

// No light sample reaches a lamp in glass.
TEST(Pilot, LeavesOutExplicitPathsThatFindNothing) {
    const Pilot pilot =
        choose(load_scene(RTRAYS_SCENES "/floor_lamps/scene.json"), settings_of(LIGHT_PATHS_AUTO));
    EXPECT_FALSE(pilot.is_explicit);
    for (size_t i = 0; i < LIGHT_PATH_NUMBERS; ++i) {
        const PilotTrial &with = pilot.trials.at(i),
                         &without = pilot.trials.at(i + LIGHT_PATH_NUMBERS);
        EXPECT_NEAR(without.variance, with.variance, 1e-5 * with.variance);
        EXPECT_LT(without.cost, with.cost);
    }
}

TEST(Pilot, HasTheStrategiesOfTheSettings) {
    RenderSettings settings = settings_of(LIGHT_PATHS_AUTO);
    settings.strategies = PathStrategies::implicit_only;
    const Scene point_light = load_scene(RTRAYS_SCENES "/features/point_light.json");
    EXPECT_FALSE(choose(point_light, settings).is_explicit);
    // A layer of explicit paths that are left out would be missing.
    RenderSettings layers = settings_of(LIGHT_PATHS_AUTO);
    layers.variance = false;
    layers.separate_strategies = true;
    const Pilot pilot = choose(load_scene(RTRAYS_SCENES "/floor_lamps/scene.json"), layers);
    EXPECT_TRUE(pilot.is_explicit);
    EXPECT_EQ(pilot.trials.size(), LIGHT_PATH_NUMBERS);
}

TEST(Pilot, GoesWithCountsOfRays) {
    RenderSettings settings = settings_of(LIGHT_PATHS_AUTO);
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    const uint32_t expected = choose(scene, settings).light_paths;
    settings.count_rays = RayCounts::by_depth;
    EXPECT_EQ(choose(scene, settings).light_paths, expected);
}

// Whether a few pixels of a pilot meet the edge of the lamp must not decide: 16 light paths per
// pixel would take 30 times as long as path tracing, for a tenth of the variance.
TEST(Pilot, IsSteadyWhereTheCameraSeesALamp) {
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    RenderSettings settings = settings_of(LIGHT_PATHS_AUTO);
    settings.width = settings.height = 128;
    settings.sampler = Sampler::sobol;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        settings.seed = seed;
        EXPECT_EQ(choose(scene, settings).light_paths, 0u) << seed;
    }
}

// A lamp in glass needs no explicit paths; a point light that is switched on later does.
TEST(Pilot, GivesExplicitPathsToLightsThatAppear) {
    Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 32, "height": 32},
        "materials": {"glass": {"type": "glass", "eta": 1.5},
                      "grey": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}},
        "nodes": [
            {"name": "camera", "transform": [{"look_at": {"origin": [0, 2, 5], "target": [0, 0.5, 0], "up": [0, 1, 0]}}],
             "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}},
            {"name": "floor", "geometry": {"type": "plane"}, "material": "grey",
             "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}]},
            {"name": "shade", "geometry": {"type": "sphere", "radius": 0.5}, "material": "glass",
             "transform": [{"translate": [0, 1, 0]}]},
            {"name": "lamp", "geometry": {"type": "sphere", "radius": 0.2}, "material": "grey",
             "transform": [{"translate": [0, 1, 0]}], "light": {"type": "diffuse_area", "radiance": [9, 9, 9]}},
            {"name": "bulb", "transform": [{"translate": [1, 2, 0]}], "light": {"type": "point", "intensity": [0, 0, 0]}}]})",
        "lamps", "lamps");
    scene.update(0);
    RenderSession session(scene, settings_of(LIGHT_PATHS_AUTO), device());
    ASSERT_EQ(session.settings().strategies, PathStrategies::implicit_only);
    scene.set_property("bulb.intensity", "5,5,5");
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(session.settings().strategies, PathStrategies::mis);
    EXPECT_TRUE(session.report().at("pilot").at("explicit"));
}

// A row of pixels may show the edge of a lamp, and most of the variance.
TEST(Pilot, MeetsEveryRowAndColumnAlike) {
    for (const auto &[width, height] :
         {std::pair(1u, 1u), std::pair(32u, 32u), std::pair(33u, 32u), std::pair(96u, 64u),
          std::pair(1u, 100000u), std::pair(100000u, 1u), std::pair(128u, 128u),
          std::pair(1920u, 1080u), std::pair(7680u, 4320u)}) {
        const std::vector<uint32_t> pixels = pilot_pixels(width, height);
        const double expected = std::clamp(width * height / 8.0, 1024.0, 16384.0);
        if (width * height <= 1024) {
            EXPECT_EQ(pixels.size(), width * height);
        } else {
            EXPECT_LT(pixels.size(), 1.05 * expected) << width << " x " << height;
            EXPECT_GT(pixels.size(), 0.5 * expected) << width << " x " << height;
        }
        std::vector<uint32_t> rows(height), columns(width);
        for (const uint32_t pixel : pixels) {
            ++rows.at(pixel / width);
            ++columns[pixel % width];
        }
        for (const auto &counts : {rows, columns}) {
            const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
            EXPECT_LE(*most - *least, 1u) << width << " x " << height;
        }
    }
}

// Path tracing renders the caustic of a point light black, without any variance.
TEST(Pilot, ChoosesLightPathsIfOnlyTheySeeALight) {
    const Pilot pilot =
        choose(load_scene(RTRAYS_SCENES "/analytic/caustic.json"), settings_of(LIGHT_PATHS_AUTO));
    EXPECT_GT(pilot.trials.front().per_pixel, 0);
    EXPECT_GT(pilot.light_paths, 0u);
}

TEST(Pilot, ChoosesTheSameWhateverTheStreams) {
    RenderSettings settings = settings_of(LIGHT_PATHS_AUTO);
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    const Pilot expected = choose(scene, settings);
    settings.stream_capacity = 3000;
    settings.group_size = 16;
    settings.stream_chunk = 7;
    const Pilot other = choose(scene, settings);
    EXPECT_EQ(other.light_paths, expected.light_paths);
    ASSERT_EQ(other.trials.size(), expected.trials.size());
    for (size_t i = 0; i < expected.trials.size(); ++i) {
        EXPECT_EQ(other.trials[i].variance, expected.trials[i].variance);
        EXPECT_EQ(other.trials[i].cost, expected.trials[i].cost);
    }
}

TEST(Pilot, IsDiscardedAndRecorded) {
    const RenderSettings automatic = settings_of(LIGHT_PATHS_AUTO);
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_mirrors/scene.json");
    const RenderSession session(scene, automatic, device());
    const nlohmann::json report = session.report();
    const auto chosen = report.at("pilot").at("light_paths").get<uint32_t>();
    // Nothing is rendered yet: the times are those of the pilot.
    EXPECT_EQ(report.at("seconds").at("device"), report.at("pilot").at("seconds"));
    EXPECT_EQ(report.at("seconds").at("wall"), report.at("pilot").at("seconds_wall"));
    EXPECT_EQ(session.film().wall_seconds, session.stats().wall_seconds);
    EXPECT_EQ(report.at("settings").at("integrator.light_paths"), std::to_string(chosen));
    RenderSettings same = settings_of(chosen);
    same.strategies = report.at("pilot").at("explicit").get<bool>() ? PathStrategies::mis
                                                                    : PathStrategies::implicit_only;
    EXPECT_EQ(render_words("/cornell_mirrors/scene.json", automatic),
              render_words("/cornell_mirrors/scene.json", same));
}

TEST(Pilot, NoLightPathsArePathTracing) {
    const std::string scene = "/cornell_box/scene.json";
    const std::vector<int64_t> expected =
        render_words(scene, settings_of(LIGHT_PATHS_LIKE_PIXELS, "path_tracing"));
    EXPECT_EQ(render_words(scene, settings_of(0)), expected);
    RenderSettings all = settings_of(0);
    all.features = CompiledFeatures::all;
    EXPECT_EQ(render_words(scene, all), expected);
}

TEST(Pilot, IsOfTruncatedBdptAlone) {
    const Scene scene = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    expect_input_error("not supported by light_tracing", [&] {
        RenderSession(scene, settings_of(LIGHT_PATHS_AUTO, "light_tracing"), device());
    });
    expect_input_error("light_tracing needs light paths",
                       [&] { RenderSession(scene, settings_of(0, "light_tracing"), device()); });
}

}  // namespace
}  // namespace rtrays
