// SPDX-License-Identifier: MIT
// Tests of the scenes on which frames are timed: their triangle counts, visibility and lighting.
#include "experiments/harness/models/timed_scenes.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "experiments/harness/models/meshes.h"
#include "experiments/harness/models/san_miguel.h"
#include "reference/renderer.h"
#include "renderer/base/error.h"
#include "renderer/base/files.h"

namespace rtrays {
namespace {

namespace fs = std::filesystem;

constexpr const char *procedural[] = {"court_3000", "court_3000_upper", "hall_3000",
                                      "landscape_3000", "city_3000"};

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
        // Some camera rays hit the sky, but enough hit surfaces and scatter.
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
    for (const char *name :
         {"court_", "court_1e3", "court_100_lower", "hall_100_upper", "nowhere"}) {
        EXPECT_FALSE(has_timed_scene(name)) << name;
        try {
            load_timed_scene(name, Surfaces::own);
            ADD_FAILURE() << name;
        } catch (const Error &error) {
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
            EXPECT_NE(std::string(error.what()).find("court_N_upper"), std::string::npos)
                << error.what();
        }
    }
}

/// Two triangles with normals and texture coordinates, each an object. The file is not compressed,
/// which the reader accepts.
class SanMiguelFiles : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(folder);
        write_file(model,
                   "ply\nformat ascii 1.0\nelement vertex 4\n"
                   "property float x\nproperty float y\nproperty float z\n"
                   "property float nx\nproperty float ny\nproperty float nz\n"
                   "property float u\nproperty float v\nelement face 2\n"
                   "property list uchar int vertex_indices\nend_header\n"
                   "0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n1 1 0 0 0 1 1 1\n"
                   "3 0 1 2\n3 2 1 3\n");
        write_file(materials,
                   "newmtl stone\nKd 0.5 0.5 0.5\nillum 1\n\nnewmtl leaf\nKd 0 1 0\nillum 1\n");
    }
    void TearDown() override { fs::remove_all(folder); }

    void place(const std::string &lines) { write_file(instances, "# a comment\n" + lines); }
    Scene scene() const {
        Scene loaded = load_san_miguel_scene(model, instances, materials);
        loaded.update(0);
        return loaded;
    }

    const fs::path folder = fs::path(testing::TempDir()) /
                            testing::UnitTest::GetInstance()->current_test_info()->name();
    const fs::path model = folder / "model.ply.gz", instances = folder / "model.instances",
                   materials = folder / "model.mtl";
};

TEST_F(SanMiguelFiles, HaveAMeshForEachMaterial) {
    place(
        "object 0 sanmiguel_1 0 1 1\nobject 1 hojas_1 1 1 0\n"
        "instance 0 1 0 0 0 0 1 0 0 0 0 1 0\n"
        "instance 1 1 0 0 0 0 1 0 0 0 0 1 0\n"
        "instance 0 -2 0 0 5 0 1 0 0 0 0 1 0\n");
    const Scene loaded = scene();
    ASSERT_EQ(loaded.meshes().name, (std::vector<std::string>{"stone", "leaf"}));
    ASSERT_EQ(loaded.meshes().triangle.size(), 3u);
    EXPECT_EQ(loaded.meshes().triangle_mesh, (std::vector<uint32_t>{0, 1, 1}));
    const std::vector<Triangle> &triangles = loaded.meshes().triangle;
    const auto corner = [&](size_t i, size_t k) {
        return Eigen::Vector3f(loaded.meshes().position[triangles[i][k]]);
    };
    // The mirrored triangle still faces +z, because the order of its corners is reversed.
    const Eigen::Vector3f normal = (corner(2, 1) - corner(2, 0)).cross(corner(2, 2) - corner(2, 0));
    EXPECT_EQ(corner(2, 0), Eigen::Vector3f(5, 0, 0));
    EXPECT_EQ(normal, Eigen::Vector3f(0, 0, 2));
    EXPECT_EQ(loaded.meshes().normal[triangles[2][0]], Eigen::Vector3f(0, 0, 1));
    EXPECT_EQ(loaded.meshes().uv[triangles[0][2]], Eigen::Vector2f(1, 1));

    const test::Mesh whole = load_san_miguel(model, instances, SanMiguelPart::whole);
    EXPECT_EQ(whole.triangles.size(), 3u);
    EXPECT_EQ(
        load_san_miguel(model, instances, SanMiguelPart::building_and_plants).triangles.size(), 2u);
}

TEST_F(SanMiguelFiles, AreRefusedByLine) {
    const auto complaint = [&](const std::string &lines) {
        place(lines);
        try {
            scene();
        } catch (const Error &error) {
            EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
            return std::string(error.what());
        }
        return std::string("none");
    };
    EXPECT_NE(complaint("object 0 a 1 2 0\n").find("model.instances:2"), std::string::npos);
    EXPECT_NE(complaint("object 1 a 0 1 0\n").find("model.instances:2"), std::string::npos);
    EXPECT_NE(complaint("object 0 a 0 1 0\ninstance 1 1 0 0 0 0 1 0 0 0 0 1 0\n")
                  .find("model.instances:3"),
              std::string::npos);
    EXPECT_NE(complaint("object 0 a 0 1 0\ninstance 0 1 0 0\n").find("model.instances:3"),
              std::string::npos);
    EXPECT_NE(complaint("object 0 a 0 1 2\n").find("material 2"), std::string::npos);
}

}  // namespace
}  // namespace rtrays
