// SPDX-License-Identifier: MIT
// Tests the options that change a loaded scene.
#include "renderer/import/scene_options.h"

#include <gtest/gtest.h>

#include <string>

#include "renderer/base/files.h"
#include "renderer/base/image.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

/// A scene whose camera is on a scaled and turned node. `up` is the camera's upward direction.
Scene scene_with(const std::string &light = R"({"type": "dome", "radiance": [1, 1, 1]})",
                 const std::string &camera = R"({"type": "pinhole", "fov": 40, "fov_axis": "x"})",
                 const std::string &up = "[0, 1, 0]") {
    return parse_scene_json(R"({"version": 1, "film": {"width": 8, "height": 8},
        "materials": {"grey": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}},
        "nodes": [
            {"name": "rig", "transform": [{"scale": [2, 2, 2]}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}}],
             "children": [{"name": "eye", "camera": )" +
                                camera + R"(,
                 "transform": [{"look_at": {"origin": [1, 2, 3], "target": [0, 0, 0], "up": )" +
                                up + R"(}}]}]},
            {"name": "ball", "geometry": {"type": "sphere", "radius": 1}, "material": "grey"},
            {"name": "sky", "light": )" +
                                light + "}]}",
                            "test.json", "test");
}

SceneOptions looking(const std::string &eye, const std::string &target) {
    SceneOptions options;
    options.look_at = {eye, target};
    return options;
}

Matrix4d pose(const Scene &scene) {
    return scene.cameras().world_from_camera.at(static_cast<size_t>(scene.active_camera()));
}

void expect_direction(const Vector3d &found, const Vector3d &expected) {
    EXPECT_LT((found.normalized() - expected.normalized()).norm(), 1e-12);
}

TEST(SceneOptions, LookAtPlacesTheCameraInTheCoordinatesOfTheScene) {
    Scene scene = scene_with();
    change_view(scene, looking("4,-3,6.5", "0,1,0"));
    const Matrix4d at = pose(scene);
    EXPECT_LT((at.block<3, 1>(0, 3) - Vector3d(4, -3, 6.5)).norm(), 1e-12);
    expect_direction(-at.block<3, 1>(0, 2), Vector3d(-4, 4, -6.5));
    EXPECT_NEAR(at(1, 0), 0, 1e-12) << "the horizon is level";
    EXPECT_GT(at(1, 1), 0);
    EXPECT_EQ(scene.cameras().fov.front(), scene_with().cameras().fov.front());
}

TEST(SceneOptions, LookAtKeepsTheUprightAxis) {
    Scene scene =
        scene_with(R"({"type": "dome", "radiance": [1, 1, 1]})",
                   R"({"type": "pinhole", "fov": 40, "fov_axis": "x"})", "[0.1, 0.05, -1]");
    change_view(scene, looking("5,0,0", "0,0,0"));
    expect_direction(pose(scene).block<3, 1>(0, 1), -Vector3d::UnitZ());
    // Along the upright axis another one has to be upright.
    change_view(scene, looking("0,0,9", "0,0,0"));
    expect_direction(-pose(scene).block<3, 1>(0, 2), -Vector3d::UnitZ());
}

TEST(SceneOptions, FovIsThatOfTheCamera) {
    Scene scene = scene_with();
    SceneOptions options;
    options.fov = 25;
    change_view(scene, options);
    EXPECT_EQ(scene.hash(), [] {
        Scene other = scene_with();
        other.set_property("eye.fov", "25");
        other.update(0);
        return other.hash();
    }());
    Scene flat = scene_with(R"({"type": "dome", "radiance": [1, 1, 1]})",
                            R"({"type": "orthographic", "size": 3, "size_axis": "x"})");
    expect_input_error("--fov", [&] { change_view(flat, options); });
}

TEST(SceneOptions, EnvironmentReplacesLightsAtInfinity) {
    const std::string sky = testing::TempDir() + "scene_options_sky.exr";
    Image image = Image::rgb(4, 2);
    write_exr(image, sky);
    SceneOptions options;
    options.environment = sky;
    const auto load_with = [&](const std::string &light) {
        const std::string path = testing::TempDir() + "scene_options.json";
        write_file(path, R"({"version": 1, "film": {"width": 8, "height": 8}, "nodes": [
            {"name": "eye", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}},
            {"name": "light", "light": )" +
                             light + "}]}");
        Scene scene = load_scene(path, true, options);
        set_scene_property(scene, "scene.environment.scale=3");  // as --set does
        change_view(scene, options);
        return scene;
    };
    const Scene dome = load_with(R"({"type": "dome", "radiance": [1, 1, 1]})");
    ASSERT_EQ(dome.lights().kind.size(), 1u);
    EXPECT_EQ(dome.lights().kind.front(), LightArrays::Kind::environment);
    EXPECT_EQ(dome.lights().image.front()->width, 4);
    EXPECT_EQ(load_with(R"({"type": "point", "intensity": [1, 1, 1]})").lights().kind.size(), 2u)
        << "lamps stay";
    options.environment = sky + ".missing";
    expect_input_error("--environment",
                       [&] { load_with(R"({"type": "point", "intensity": [1, 1, 1]})"); });
}

TEST(SceneOptions, ErrorsNameTheOption) {
    for (const std::string text : {"1,2", "1,2,3,4", "1 2 3", "a,b,c", "1,2,", ""}) {
        Scene scene = scene_with();
        expect_input_error("--look-at '" + text + "': expected X,Y,Z",
                           [&] { change_view(scene, looking(text, "0,0,0")); });
    }
    Scene scene = scene_with();
    expect_input_error("--look-at", [&] { change_view(scene, looking("1,2,3", "1,2,3")); });
    EXPECT_FALSE(set_scene_property(scene, "integrator.sampler=sobol"));
    expect_input_error("--set scene.eye.fov: expected NAME=VALUE",
                       [&] { set_scene_property(scene, "scene.eye.fov"); });
}

}  // namespace
}  // namespace rtrays
