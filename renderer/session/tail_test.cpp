// SPDX-License-Identifier: MIT
// Tests that tracing the last few paths of a batch to their end in one launch gives the same bits
// and ray counts as tracing them in rounds.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/scene/scene.h"
#include "renderer/session/render_session.h"

namespace rtrays {
namespace {

/// Returns a bright room with a glass ball. If the room absorbs little, paths continue for
/// thousands of events.
Scene bright_room(double albedo) {
    std::ifstream file(RTRAYS_SCENES "/analytic/furnace_090.json");
    nlohmann::json room = nlohmann::json::parse(file);
    room["nodes"][1]["material"]["reflectance"] = {albedo, albedo, albedo};
    room["nodes"].push_back({{"name", "ball"},
                             {"geometry", {{"type", "sphere"}, {"radius", 0.4}}},
                             {"transform", {{{"translate", {-0.5, 0.4, -0.5}}}}},
                             {"material", {{"type", "glass"}, {"eta", 1.5}}}});
    return parse_scene_json(room.dump(), "bright_room", "bright_room");
}

struct Rendered {
    FilmState film;
    nlohmann::json report;
    std::map<std::string, int> launches;  ///< launches of run_tail per pass
};

/// Renders two batches. If the last paths of the first batch are long, it compiles run_tail.
Rendered render(const Scene &scene, const std::string &algorithm,
                const std::vector<std::string> &assignments) {
    static DeviceContext device;
    RenderSettings settings;
    settings.algorithm = &algorithm_named(algorithm);
    settings.width = 12;
    settings.height = 9;
    settings.stream_capacity = 200;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    RenderSession session(scene, settings, device);
    session.render(0, 4);
    session.render(4, 8);
    Rendered rendered = {session.film(), session.report(), {}};
    require_valid(rendered.film);
    for (const auto &stage : rendered.report["stages"]) {
        if (stage.at("name") == "run_tail") {
            rendered.launches[stage.at("pass")] = stage.at("launches");
        }
    }
    return rendered;
}

/// Compares with a rendering that traces all paths in rounds, which counting rays by depth
/// enforces.
void expect_bits_of_rounds(const Scene &scene, const std::string &algorithm,
                           const std::vector<std::string> &passes,
                           std::vector<std::string> assignments = {}) {
    const Rendered far = render(scene, algorithm, assignments);
    assignments.emplace_back("device.count_rays=by_depth");
    const Rendered rounds = render(scene, algorithm, assignments);
    const std::string with = algorithm + testing::PrintToString(assignments);
    EXPECT_EQ(far.film.words, rounds.film.words) << with;
    EXPECT_EQ(far.report["rays"], rounds.report["rays"]) << with;
    EXPECT_LT(far.report["rounds"], rounds.report["rounds"]) << with;
    EXPECT_TRUE(rounds.launches.empty()) << with;
    for (const std::string &pass : passes) {
        EXPECT_GT(far.launches.count(pass), 0u) << with << " " << pass;
    }
}

TEST(Tail, HasTheBitsOfRounds) {
    const Scene room = bright_room(0.999);
    expect_bits_of_rounds(room, "light_tracing", {"light"});
    expect_bits_of_rounds(room, "truncated_bdpt", {"camera", "light"});
    // With 40 vertices the tail must wait for rounds that connect vertices.
    expect_bits_of_rounds(room, "bdpt", {"camera", "light"}, {"integrator.bdpt_vertices=40"});
}

TEST(Tail, HasTheBitsOfRoundsInAnotherLayoutAndUnderControl) {
    const Scene room = bright_room(0.998);
    expect_bits_of_rounds(
        room, "path_tracing", {"camera"},
        {"device.path_layout=arrays", "device.group_size=8", "device.stream_chunk=7"});
    expect_bits_of_rounds(room, "path_tracing", {"camera"},
                          {"integrator.convergence.error=0.02", "integrator.convergence.start=4",
                           "integrator.convergence.interval=4"});
}

TEST(Tail, IsTracedInRoundsWherePathsAreShort) {
    EXPECT_TRUE(render(bright_room(0.5), "path_tracing", {}).launches.empty());
}

}  // namespace
}  // namespace rtrays
