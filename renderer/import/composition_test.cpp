// SPDX-License-Identifier: MIT
// Tests scene files that contain others: overlays and imports.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "renderer/base/files.h"
#include "renderer/import/load_scene.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

const std::string box = RTRAYS_SCENES "/cornell_box/scene.json";

class Composition : public testing::Test {
  protected:
    Composition() : folder_(testing::TempDir() + "composition") {
        std::filesystem::create_directories(folder_);
    }
    ~Composition() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string &name, const std::string &text) const {
        const std::string path = (folder_ / name).string();
        write_file(path, text);
        return path;
    }

    std::filesystem::path folder_;
};

class Overlay : public Composition {};
class Import : public Composition {};

Scene changed_box() {
    Scene scene = load_scene(box);
    scene.set_property("luminaire.radiance", "[9, 6, 2]");
    scene.set_property("materials.white.reflectance", "0.5");
    scene.update(0);
    return scene;
}

TEST_F(Overlay, ChangesPropertiesOfItsBase) {
    const std::string path = write("dim.json", R"({"version": 1, "base": ")" + box + R"(",
        "set": {"luminaire.radiance": [9, 6, 2], "materials.white.reflectance": 0.5}})");
    const Scene scene = load_scene(path);
    EXPECT_EQ(scene.hash(), changed_box().hash());
    EXPECT_NE(scene.hash(), load_scene(box).hash());
    EXPECT_EQ(scene.name(), "dim");
    EXPECT_EQ(scene.film_width(), load_scene(box).film_width());
}

TEST_F(Overlay, MayLieOnAnotherOne) {
    write("first.json", R"({"version": 1, "name": "first", "base": ")" + box + R"(",
        "set": {"luminaire.radiance": [1, 1, 1], "materials.white.reflectance": [0.5, 0.5, 0.5]}})");
    const Scene scene = load_scene(write("second.json", R"({"version": 1, "base": "first.json",
        "set": {"luminaire.radiance": "9,6,2"}, "film": {"width": 20, "height": 10}})"));
    EXPECT_EQ(scene.hash(), changed_box().hash());
    EXPECT_EQ(scene.film_width(), 20);
    EXPECT_EQ(scene.film_height(), 10);
    expect_input_error("does one contain itself", [&] {
        load_scene(write("circle.json", R"({"version": 1, "base": "circle.json"})"));
    });
}

TEST_F(Overlay, SelectsACameraOfItsBase) {
    write("two.json", R"({"version": 1, "film": {"width": 8, "height": 8}, "camera": "a", "nodes": [
        {"name": "a", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}},
        {"name": "b", "camera": {"type": "pinhole", "fov": 50, "fov_axis": "x"}}]})");
    const Scene scene =
        load_scene(write("b.json", R"({"version": 1, "base": "two.json", "camera": "b"})"));
    EXPECT_EQ(scene.cameras().name.at(static_cast<size_t>(scene.active_camera())), "b");
}

TEST_F(Overlay, ErrorsNameFileLineAndAddress) {
    const auto load = [&](const std::string &members) {
        return [this, members] {
            load_scene(
                write("over.json", "{\"version\": 1,\n\"base\": \"" + box + "\"" + members + "}"));
        };
    };
    expect_input_error("over.json:4: /set/luminaire.radiances: ",
                       load(",\n\"set\": {\n\"luminaire.radiances\": 3}"));
    expect_input_error(
        "'luminaire' has no property 'radiances'; did you mean 'radiance'? properties are: ",
        load(",\n\"set\": {\n\"luminaire.radiances\": 3}"));
    expect_input_error("over.json:3: /set/luminaire.radiance: ",
                       load(",\n\"set\": {\"luminaire.radiance\": \"bright\"}"));
    expect_input_error("over.json:3: /camera: ", load(",\n\"camera\": \"nobody\""));
    expect_input_error("nodes", load(",\n\"nodes\": []"));
    expect_input_error("over.json:2: /base: ", [&] {
        load_scene(write("over.json", "{\"version\": 1,\n\"base\": \"nowhere.json\"}"));
    });
    expect_input_error("nowhere.json", [&] {
        load_scene(write("over.json", "{\"version\": 1,\n\"base\": \"nowhere.json\"}"));
    });
}

const std::string frame = R"({"version": 1, "film": {"width": 8, "height": 8}, "nodes": [
    {"name": "eye", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}},
    {"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}},)";

const std::string part = R"({"version": 1, "film": {"width": 8, "height": 8},
    "materials": {"paint": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}},
    "nodes": [
        {"name": "eye", "camera": {"type": "pinhole", "fov": 70, "fov_axis": "x"}},
        {"name": "arm", "transform": [{"translate": [1, 0, 0]}], "children": [
            {"name": "ball", "geometry": {"type": "sphere", "radius": 1}, "material": "paint"}]}]})";

TEST_F(Import, AddsTheNodesOfAnotherScene) {
    write("part.json", part);
    const Scene scene = load_scene(write("all.json", frame + R"(
        {"name": "left", "import": "part.json", "transform": [{"translate": [0, 3, 0]}]},
        {"name": "right", "import": "part.json", "transform": [{"scale": [2, 2, 2]}],
         "set": {"materials.paint.reflectance": [0.1, 0.2, 0.3], "ball.radius": 0.5}}]})"));
    const Scene expected = load_scene(write("expected.json", frame + R"(
        {"name": "a", "transform": [{"translate": [0, 3, 0]}], "children": [
            {"name": "b", "transform": [{"translate": [1, 0, 0]}],
             "geometry": {"type": "sphere", "radius": 1},
             "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}}]},
        {"name": "c", "transform": [{"scale": [2, 2, 2]}], "children": [
            {"name": "d", "transform": [{"translate": [1, 0, 0]}],
             "geometry": {"type": "sphere", "radius": 0.5},
             "material": {"type": "lambert", "reflectance": [0.1, 0.2, 0.3]}}]}]})"));
    EXPECT_EQ(scene.hash(), expected.hash());
    EXPECT_EQ(scene.cameras().name.size(), 3u);
    EXPECT_EQ(scene.cameras().name.at(static_cast<size_t>(scene.active_camera())), "eye");
}

TEST_F(Import, ObjectsAreFoundByThePrefixedName) {
    write("part.json", part);
    Scene scene =
        load_scene(write("all.json", frame + R"({"name": "left", "import": "part.json"}]})"));
    scene.set_property("materials.left/paint.reflectance", "0.25");
    scene.set_property("left/ball.radius", "3");
    scene.update(0);
    EXPECT_EQ(scene.materials().component.front().weight, Eigen::Vector3f(0.25f, 0.25f, 0.25f));
    expect_input_error("left/ball", [&] { scene.set_property("ball.radius", "3"); });
    scene.set_active_camera("left/eye");
}

TEST_F(Import, ReadsModelsWithoutStandIns) {
    std::filesystem::copy_file(RTRAYS_CORPUS "/square.ply", folder_ / "square.ply");
    const Scene scene =
        load_scene(write("all.json", frame + R"({"name": "square", "import": "square.ply"}]})"));
    EXPECT_EQ(scene.cameras().name.size(), 1u);
    EXPECT_EQ(scene.lights().kind.size(), 1u);
    EXPECT_FALSE(scene.meshes().name.empty());
}

TEST_F(Import, ReadsMitsubaScenesWithoutSensors) {
    write("part.xml", R"(<scene version="3.0.0"><shape type="sphere" id="ball"/></scene>)");
    const Scene scene =
        load_scene(write("all.json", frame + R"({"name": "part", "import": "part.xml"}]})"));
    EXPECT_EQ(scene.arrays().shapes.name.size(), 1u);
    EXPECT_EQ(scene.cameras().name.size(), 1u);
    expect_input_error("no sensor", [&] { load_scene((folder_ / "part.xml").string()); });
}

TEST_F(Import, ErrorsNameBothFiles) {
    expect_input_error("nowhere.json", [&] {
        load_scene(write("all.json", frame + R"({"name": "left", "import": "nowhere.json"}]})"));
    });
    expect_input_error("does one contain itself", [&] {
        load_scene(write("all.json", frame + R"({"name": "left", "import": "all.json"}]})"));
    });
    write("part.json", part);
    expect_input_error("all.json:4: /nodes/2/set/ball.size: ", [&] {
        load_scene(write("all.json", frame + R"(
            {"name": "left", "import": "part.json", "set": {"ball.size": 3}}]})"));
    });
    expect_input_error("set", [&] {
        load_scene(write("all.json", frame + R"({"name": "left", "set": {"ball.radius": 3}}]})"));
    });
    expect_input_error("two nodes have the name 'left/ball'", [&] {
        load_scene(write("all.json", frame + R"({"name": "left/ball"},
            {"name": "left", "import": "part.json"}]})"));
    });
}

}  // namespace
}  // namespace rtrays
