// SPDX-License-Identifier: MIT
// Tests the notices of light that an algorithm cannot see.
#include "renderer/integrators/unseen_light.h"

#include <gtest/gtest.h>

#include "renderer/import/json/scene_json.h"
#include "renderer/scene/scene.h"

namespace rtrays {
namespace {

const std::string floor_node =
    R"(, {"name": "floor", "geometry": {"type": "rectangle"}, "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}})";
const std::string ground_node =
    R"(, {"name": "ground", "geometry": {"type": "plane"}, "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}})";
const std::string ball_node =
    R"(, {"name": "ball", "geometry": {"type": "sphere", "radius": 1}, "material": {"type": "glass", "eta": 1.5}})";
const std::string lamp_node =
    R"(, {"name": "lamp", "geometry": {"type": "disc", "radius": 1}, "material": {"type": "lambert", "reflectance": [0, 0, 0], "emission": [1, 1, 1]}})";
const std::string dome_node =
    R"(, {"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}})";

std::string bulb_node(const std::string &name, const std::string &intensity = "[1, 1, 1]") {
    return R"(, {"name": ")" + name + R"(", "light": {"type": "point", "intensity": )" + intensity +
           "}}";
}

Scene scene_of(const std::string &nodes) {
    return parse_scene_json(R"({"version": 1, "film": {"width": 4, "height": 4}, "nodes": [
        {"name": "camera", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}})" +
                                nodes + "]}",
                            "test", "test");
}

std::vector<std::string> unseen(const std::string &algorithm, const std::string &nodes,
                                uint32_t max_depth = 0) {
    return unseen_light(algorithm_named(algorithm), scene_of(nodes).arrays(), max_depth);
}

using Sentences = std::vector<std::string>;

TEST(UnseenLight, NamesCausticsThatCameraPathsCannotFind) {
    const std::string scene = floor_node + ball_node + bulb_node("bulb");
    EXPECT_EQ(unseen("path_tracing", scene),
              Sentences({"path_tracing does not see E D ... S L: caustics of point, spot and "
                         "directional lights (here 'bulb'); bdpt and truncated_bdpt do"}));
    EXPECT_EQ(unseen("path_tracing", scene, 1), Sentences()) << "a caustic has two events";
    EXPECT_EQ(unseen("path_tracing", floor_node + bulb_node("bulb")), Sentences());
    EXPECT_EQ(unseen("path_tracing", ball_node + bulb_node("bulb")), Sentences());
    EXPECT_EQ(unseen("path_tracing", floor_node + ball_node + dome_node), Sentences());
    EXPECT_EQ(
        unseen("path_tracing", floor_node + ball_node + dome_node + bulb_node("off", "[0, 0, 0]")),
        Sentences())
        << "a light without power";
}

TEST(UnseenLight, ListsLightsThatNoPathHits) {
    const std::string scene = floor_node + dome_node;
    EXPECT_EQ(lights_not_hit(scene_of(scene).arrays()), "");
    EXPECT_EQ(lights_not_hit(scene_of(scene + bulb_node("a") + bulb_node("b")).arrays()),
              "'a' and 'b'");
    EXPECT_EQ(lights_not_hit(scene_of(scene + bulb_node("off", "[0, 0, 0]")).arrays()), "");
}

TEST(UnseenLight, ListsAFewLights) {
    std::string scene = floor_node + ball_node;
    for (const char *name : {"a", "b", "c", "d"}) {
        scene += bulb_node(name);
    }
    ASSERT_EQ(unseen("path_tracing", scene).size(), 1u);
    EXPECT_NE(unseen("path_tracing", scene)[0].find("(here 'a', 'b' and 2 more)"),
              std::string::npos)
        << unseen("path_tracing", scene)[0];
}

TEST(UnseenLight, NamesMirrorImagesThatNoStrategyFinds) {
    const std::string scene = floor_node + ball_node + bulb_node("bulb");
    const Sentences truncated = unseen("truncated_bdpt", scene), full = unseen("bdpt", scene);
    ASSERT_EQ(truncated.size(), 2u);
    ASSERT_EQ(full.size(), 1u);
    EXPECT_NE(full[0].find("'bulb'); no algorithm does"), std::string::npos) << full[0];
    EXPECT_NE(truncated[1].find("illuminates (here 'bulb'); bdpt does"), std::string::npos)
        << truncated[1];
    EXPECT_EQ(unseen("truncated_bdpt", scene, 2), Sentences());
}

TEST(UnseenLight, NamesWhatIsNotConnectedToTheCamera) {
    const Sentences sentences =
        unseen("light_tracing", ground_node + ball_node + lamp_node + dome_node);
    ASSERT_EQ(sentences.size(), 3u);
    EXPECT_NE(sentences[0].find(
                  "seen directly (dome, environment) (here 'sky'); bdpt and truncated_bdpt do"),
              std::string::npos)
        << sentences[0];
    EXPECT_NE(sentences[1].find("bounding sphere"), std::string::npos) << sentences[1];
    EXPECT_NE(sentences[2].find("mirrors and smooth glass (here 'lamp' and 'sky')"),
              std::string::npos)
        << sentences[2];
    EXPECT_EQ(unseen("light_tracing", floor_node + lamp_node), Sentences());
}

TEST(UnseenLight, SaysThatAllIsDark) {
    for (const char *algorithm : {"path_tracing", "bdpt", "truncated_bdpt"}) {
        const Sentences sentences = unseen(algorithm, floor_node + bulb_node("off", "[0, 0, 0]"));
        ASSERT_EQ(sentences.size(), 1u) << algorithm;
        EXPECT_NE(sentences[0].find("the scene has no light"), std::string::npos);
    }
    EXPECT_EQ(unseen("whitted", floor_node), Sentences()) << "it is lit from the camera";
}

}  // namespace
}  // namespace rtrays
