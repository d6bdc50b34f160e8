// SPDX-License-Identifier: MIT
// The scenes that frames are timed on: what their names say is there, in sight, and lit.
#include "experiments/frames/scenes.h"

#include <gtest/gtest.h>

#include "experiments/hierarchy/meshes.h"
#include "reference/renderer.h"
#include "renderer/base/error.h"

namespace rtrays {
namespace {

constexpr const char *procedural[] = {"court_3000", "court_3000_upper", "hall_3000", "landscape_3000",
                                      "city_3000"};

TEST(TimedScenes, HaveTheTrianglesOfTheirNames) {
    for (const char *name : procedural) {
        const TimedScene timed = load_timed_scene(name, Surfaces::own);
        const bool has_lamps = std::string(name).rfind("hall", 0) == 0;
        EXPECT_EQ(timed.scene.meshes().triangle.size(), has_lamps ? 3006u : 3000u) << name;
        EXPECT_TRUE(timed.is_procedural);
    }
    EXPECT_FALSE(load_timed_scene("cornell_box", Surfaces::own).is_procedural);
    for (const uint32_t count : {1u, 100u, 20000u}) {
        for (const char *head : {"hall", "court", "city", "scattered"}) {
            const std::string name = std::string(head) + "_" + std::to_string(count);
            const test::Mesh mesh = load_measured_mesh(name).mesh;
            EXPECT_EQ(mesh.triangles.size(), count) << name;
            for (const Eigen::Vector3f &position : mesh.positions) {
                ASSERT_TRUE(position.allFinite()) << name;
            }
        }
    }
}

TEST(TimedScenes, AreSeenAndLit) {
    for (const char *name : procedural) {
        const TimedScene timed = load_timed_scene(name, Surfaces::diffuse);
        ReferenceSettings settings;
        settings.width = 16;
        settings.height = 12;
        settings.camera = static_cast<size_t>(timed.scene.active_camera());
        settings.max_depth = 2;
        ReferenceRenderer renderer(timed.scene.arrays(), settings);
        renderer.render(0, 64);
        size_t lit = 0;
        for (const float red : renderer.develop().channel("R")) {
            lit += red > 0 ? 1 : 0;
        }
        EXPECT_GT(lit, 0.95 * 16 * 12) << name;
        // Some look into the sky, but not all: what is hit scatters.
        EXPECT_GT(static_cast<double>(renderer.stats().bounce_rays),
                  0.2 * static_cast<double>(renderer.stats().camera_rays))
            << name;
    }
}

TEST(TimedScenes, AreDiffuseWhereAsked) {
    EXPECT_EQ(load_timed_scene("court_100", Surfaces::own).scene.materials().component.size(), 2u);
    const TimedScene diffuse = load_timed_scene("cornell_box", Surfaces::diffuse);
    for (const BxdfComponent &component : diffuse.scene.materials().component) {
        EXPECT_EQ(component.weight[0], 0.6f);
    }
}

TEST(TimedScenes, OthersAreRefused) {
    for (const char *name : {"court_", "court_1e3", "court_100_lower", "hall_100_upper", "nowhere"}) {
        EXPECT_FALSE(has_timed_scene(name)) << name;
        try {
            load_timed_scene(name, Surfaces::own);
            ADD_FAILURE() << name;
        } catch (const Error &error) {
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
            EXPECT_NE(std::string(error.what()).find("court_N_upper"), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace rtrays
