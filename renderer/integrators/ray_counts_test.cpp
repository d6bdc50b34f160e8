// SPDX-License-Identifier: MIT
// Tests the counts of rays by depth.
#include "renderer/shared/ray_counts.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

constexpr uint64_t pixels = 16 * 16;

DeviceContext &device() {
    static DeviceContext context;
    return context;
}

struct Rendered {
    std::vector<int64_t> words;
    nlohmann::json report;
};

Rendered render(const Scene &scene, const std::string &algorithm,
                const std::vector<std::string> &assignments, uint64_t samples = 5) {
    RenderSettings settings;
    settings.algorithm = &algorithm_named(algorithm);
    settings.width = settings.height = 16;
    settings.stream_capacity = 100;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    RenderSession session(scene, settings, device());
    session.render(0, samples);
    return {session.film().words, session.report()};
}

/// Returns a scene with a camera and a point light in a sphere. No path leaves it, and the light
/// reaches every hit.
Scene closed_sphere() {
    return parse_scene_json(R"({"version": 1, "film": {"width": 16, "height": 16}, "nodes": [
        {"name": "camera", "transform": [{"look_at": {"origin": [0.5, 0, 0], "target": [0, 0, 1], "up": [0, 1, 0]}}],
         "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}},
        {"name": "wall", "geometry": {"type": "sphere", "radius": 2}, "material": {"type": "lambert", "reflectance": [1, 1, 1]}},
        {"name": "lamp", "transform": [{"translate": [0, 0.5, 0]}], "light": {"type": "point", "intensity": [1, 1, 1]}}]})",
                            "test", "test");
}

TEST(RayCounts, AreExactInAClosedScene) {
    const Scene scene = closed_sphere();
    const std::vector<std::string> by_depth = {"device.count_rays=by_depth",
                                               "integrator.strategies=explicit",
                                               "integrator.termination=fixed"};
    const auto rays = [&](const std::string &max_depth) {
        std::vector<std::string> assignments = by_depth;
        assignments.push_back("integrator.max_depth=" + max_depth);
        return render(scene, "path_tracing", assignments).report["passes"][0]["rays_by_depth"];
    };
    const nlohmann::json four = rays("4");
    const std::vector<uint64_t> all(4, 5 * pixels);
    EXPECT_EQ(four["nearest"].get<std::vector<uint64_t>>(), all);
    EXPECT_EQ(four["shadow"].get<std::vector<uint64_t>>(), all);
    std::vector<uint64_t> deep(RAY_DEPTHS, 5 * pixels);
    deep.back() *= 7;  // depths 63 to 69
    EXPECT_EQ(rays("70")["nearest"].get<std::vector<uint64_t>>(), deep);
    EXPECT_EQ(rays("70")["shadow"].get<std::vector<uint64_t>>(), deep);
}

TEST(RayCounts, AddUpToTheTotalsAndChangeNoBit) {
    const Scene box = load_scene(RTRAYS_SCENES "/cornell_box/scene.json");
    for (const std::string &algorithm : algorithm_names()) {
        const Rendered plain = render(box, algorithm, {}),
                       counted = render(box, algorithm, {"device.count_rays=by_depth"});
        EXPECT_EQ(counted.words, plain.words) << algorithm;
        uint64_t nearest = 0, shadow = 0;
        for (const nlohmann::json &pass : counted.report["passes"]) {
            const auto of_pass =
                pass.at("rays_by_depth").at("nearest").get<std::vector<uint64_t>>();
            const auto shadow_of_pass =
                pass.at("rays_by_depth").at("shadow").get<std::vector<uint64_t>>();
            nearest = std::accumulate(of_pass.begin(), of_pass.end(), nearest);
            shadow = std::accumulate(shadow_of_pass.begin(), shadow_of_pass.end(), shadow);
        }
        EXPECT_GT(shadow, 0u) << algorithm;
        EXPECT_EQ(counted.report["rays"],
                  (nlohmann::json{{"nearest", nearest}, {"shadow", shadow}}))
            << algorithm;
        EXPECT_EQ(plain.report["rays"], counted.report["rays"]) << algorithm;
        for (const nlohmann::json &buffer : plain.report["buffers"]) {
            EXPECT_EQ(buffer.at("name").get<std::string>().find("ray_counts"), std::string::npos);
        }
        for (const nlohmann::json &stage : plain.report["stages"]) {
            EXPECT_EQ(stage.at("name").get<std::string>().find("count_"), std::string::npos);
        }
        EXPECT_FALSE(plain.report["passes"][0].contains("rays_by_depth"));
    }
}

TEST(RayCounts, NeedStreams) {
    RenderSettings settings;
    apply_setting(settings, "device.pipeline=megakernel");
    apply_setting(settings, "device.count_rays=by_depth");
    expect_input_error("device.count_rays=by_depth: counts rays in the streams",
                       [&] { require_consistent(settings); });
}

}  // namespace
}  // namespace rtrays
