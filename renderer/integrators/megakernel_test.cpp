// SPDX-License-Identifier: MIT
// Tests path tracing in one kernel: it gives the same bits and ray counts as the stages, without
// streams.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/light_scene.h"

namespace rtrays {
namespace {

DeviceContext &device() {
    static DeviceContext context;
    return context;
}

struct Rendered {
    FilmState film;
    nlohmann::json report;
};

Rendered render(const Scene &scene, const std::string &pipeline,
                std::vector<std::string> assignments) {
    RenderSettings settings;
    settings.width = 24;
    settings.height = 18;
    settings.stream_capacity = 300;
    assignments.push_back("device.pipeline=" + pipeline);
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    RenderSession session(scene, settings, device());
    session.render(0, 3);
    session.render(3, 8);
    const Rendered rendered = {session.film(), session.report()};
    require_valid(rendered.film);
    return rendered;
}

void expect_same_bits(const Scene &scene, const std::vector<std::string> &assignments) {
    const Rendered streams = render(scene, "wavefront", assignments),
                   whole = render(scene, "megakernel", assignments);
    const std::string with = testing::PrintToString(assignments);
    EXPECT_EQ(whole.film.words, streams.film.words) << with;
    EXPECT_NE(std::count(whole.film.words.begin(), whole.film.words.end(), 0),
              static_cast<long>(whole.film.words.size()))
        << with;
    EXPECT_EQ(whole.report["rays"], streams.report["rays"]) << with;
    EXPECT_EQ(whole.film.config, streams.film.config) << "films of both must be mergeable";
}

Scene scene_file(const std::string &path) {
    return load_scene(RTRAYS_SCENES "/" + path);
}

TEST(Megakernel, GivesTheBitsOfTheWavefront) {
    const Scene box = scene_file("cornell_box/scene.json");
    expect_same_bits(box, {});
    expect_same_bits(box, {"integrator.strategies=implicit"});
    expect_same_bits(box, {"integrator.strategies=explicit", "integrator.max_depth=3",
                           "integrator.sampler=sobol"});
    expect_same_bits(
        box, {"integrator.termination=adaptive", "integrator.max_depth=5", "integrator.beta=1"});
    expect_same_bits(box, {"integrator.convergence.error=0.3", "integrator.convergence.start=2",
                           "integrator.convergence.interval=2"});
}

TEST(Megakernel, GivesTheBitsOfTheWavefrontUnderEveryLight) {
    const Scene lights = parse_scene_json(light_scene_text(), "light_scene", "light_scene");
    expect_same_bits(lights, {});
    expect_same_bits(scene_file("features/point_light.json"), {});  // paths cannot hit its light
    expect_same_bits(lights,
                     {"integrator.light_selection=independent", "integrator.sphere_sampling=area"});
}

TEST(Megakernel, GivesTheBitsOfTheWavefrontForEveryKindOfSurface) {
    for (const char *name :
         {"glass", "thin_lens", "smooth_normals", "julia", "rough_glass_ggx", "car_paint"}) {
        expect_same_bits(scene_file(std::string("features/") + name + ".json"), {});
    }
}

TEST(Megakernel, GivesTheSameBitsWithEverythingCompiledInAndCutOtherwise) {
    const Scene glass = scene_file("features/glass.json");
    const Rendered streams = render(glass, "wavefront", {}),
                   all = render(glass, "megakernel", {"device.features=all"});
    EXPECT_EQ(all.film.words, streams.film.words);
    EXPECT_EQ(render(glass, "megakernel",
                     {"device.group_size=8", "device.stream_chunk=7", "device.path_layout=arrays"})
                  .film.words,
              streams.film.words)
        << "another partition of the work";
}

TEST(Megakernel, HasOneStageAndNoStreams) {
    const Scene box = scene_file("cornell_box/scene.json");
    const nlohmann::json streams = render(box, "wavefront", {}).report,
                         whole = render(box, "megakernel", {}).report;
    EXPECT_EQ(streams["pipeline"], "wavefront");
    EXPECT_EQ(whole["pipeline"], "megakernel");
    std::map<std::string, int> launches;
    for (const auto &stage : whole["stages"]) {
        launches[stage.at("name")] = stage.at("launches");
    }
    EXPECT_EQ(launches, (std::map<std::string, int>{{"trace_paths", 2}, {"carry_film", 1}}))
        << "one launch per batch; reading the film propagates carries";
    EXPECT_EQ(whole["bytes_per_path"].get<int>(), streams["bytes_per_path"].get<int>() - 12)
        << "queues need no memory";
    for (const auto &buffer : whole["buffers"]) {
        EXPECT_NE(buffer.at("name"), "path_states");
        EXPECT_NE(buffer.at("name"), "queues");
    }
}

TEST(Megakernel, RefusesOtherAlgorithms) {
    for (const Algorithm *algorithm : all_algorithms()) {
        RenderSettings settings;
        settings.algorithm = algorithm;
        settings.pipeline = Pipeline::megakernel;
        if (algorithm == &algorithms::path_tracing) {
            EXPECT_NO_THROW(require_consistent(settings));
        } else {
            expect_input_error("needs device.pipeline=wavefront",
                               [&] { require_consistent(settings); });
        }
    }
}

}  // namespace
}  // namespace rtrays
