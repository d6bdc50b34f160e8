// SPDX-License-Identifier: MIT
// Tests the number of light paths that a pilot rendering chooses.
#include "renderer/session/pilot.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/compile/device_scene.h"
#include "renderer/device/context.h"
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
    return choose_light_paths(shared, scene, settings);
}

TEST(Pilot, ChoosesTheLeastVarianceTimesRays) {
    const auto chosen = [](const std::string &scene) {
        const Pilot pilot =
            choose(load_scene(RTRAYS_SCENES + scene), settings_of(LIGHT_PATHS_AUTO));
        EXPECT_GE(pilot.trials.size(), 4u);
        const PilotTrial *best = &pilot.trials.front();
        for (const PilotTrial &trial : pilot.trials) {
            EXPECT_GT(trial.variance, 0);
            EXPECT_GT(trial.rays, 1);
            best = trial.variance * trial.rays < best->variance * best->rays ? &trial : best;
        }
        EXPECT_EQ(pilot.light_paths, static_cast<uint32_t>(best->per_pixel * 32 * 32)) << scene;
        EXPECT_GT(pilot.seconds, 0);
        EXPECT_GT(pilot.wall_seconds, 0);
        return pilot.light_paths;
    };
    // Light paths are efficient for caustics of mirrors, but not for diffuse surfaces under a point
    // light.
    EXPECT_GT(chosen("/cornell_mirrors/scene.json"), 0u);
    EXPECT_EQ(chosen("/features/point_light.json"), 0u);
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
        EXPECT_EQ(other.trials[i].rays, expected.trials[i].rays);
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
    EXPECT_EQ(render_words("/cornell_mirrors/scene.json", automatic),
              render_words("/cornell_mirrors/scene.json", settings_of(chosen)));
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
