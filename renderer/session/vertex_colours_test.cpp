// SPDX-License-Identifier: MIT
// Renders meshes with colours of vertices: closed forms for camera and light paths, and the same
// bits for every pipeline and after edits.
#include <gtest/gtest.h>

#include <array>

#include "renderer/import/json/scene_json.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::device;
using test::film_words;
using test::settings_of;

constexpr double pi = 3.14159265358979323846;

/// A triangle around the axis of the camera, which is at the barycentrics (1/5, 3/10, 1/2). Its red
/// colours are `reds`. It is lit along its normal with irradiance 2. `keys` extends its material.
Scene painted(const std::string &reds, const std::string &keys = "",
              const std::string &transform = "") {
    return parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16}, "nodes": [
        {"name": "camera", "camera": {"type": "pinhole", "fov": 5, "fov_axis": "x"}},
        {"name": "sun", "light": {"type": "directional", "irradiance": [2, 2, 2]}},
        {"name": "wall", "transform": [)" +
            transform + R"({"translate": [0, 0, -2]}],
         "geometry": {"type": "mesh", "polygons": [[0, 1, 2]],
            "vertices": [[-5, 1, 0], [5, -3, 0], [-1, 1.4, 0]])" +
            reds + R"(},
         "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5],
            "reflectance_texture": {"vertex_colours": true})" +
            keys + "}}]}",
        "in.json", "in", testing::TempDir());
}

std::string colours(const std::array<double, 3> &reds) {
    std::string text;
    for (const double red : reds) {
        text += (text.empty() ? "" : ", ") + ("[" + std::to_string(red) + ", 1, 0.5]");
    }
    return ", \"colours\": [" + text + "]";
}

/// The radiance of a reflectance 1/2 times `colour`. The view is symmetric about its centre, and
/// the colour is linear, so its mean is that of the centre.
double radiance(double colour) {
    return 0.5 * colour * 2 / pi;
}

TEST(VertexColours, AreInterpolatedWithTheBarycentrics) {
    const RenderSettings settings = settings_of("path_tracing");
    test::expect_mean(painted(colours({1, 0, 0})), settings, radiance(0.2), 1e-3);
    test::expect_mean(painted(colours({0, 1, 0})), settings, radiance(0.3), 1e-3);
    test::expect_mean(painted(colours({0, 0.25, 1})), settings, radiance(0.575), 1e-3);
}

TEST(VertexColours, MultiplyTheReflectanceForAllKindsOfPaths) {
    // A smaller wall, which many light paths hit. Its colour is linear, and 0.6 at the centre.
    const Scene scene = parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16}, "nodes": [
        {"name": "camera", "camera": {"type": "pinhole", "fov": 20, "fov_axis": "x"}},
        {"name": "sun", "light": {"type": "directional", "irradiance": [2, 2, 2]}},
        {"name": "wall", "transform": [{"translate": [0, 0, -2]}],
         "geometry": {"type": "mesh", "polygons": [[0, 1, 2, 3]],
            "vertices": [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]],
            "colours": [[0.2, 1, 1], [0.8, 1, 1], [1, 1, 1], [0.4, 1, 1]]},
         "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5],
            "reflectance_texture": {"vertex_colours": true}}}]})",
        "in.json", "in", testing::TempDir());
    for (const char *algorithm : {"path_tracing", "light_tracing", "bdpt", "truncated_bdpt"}) {
        test::expect_mean(scene, settings_of(algorithm), radiance(0.6), 1e-3);
    }
}

TEST(VertexColours, AreWhiteWhereAMeshHasNone) {
    test::expect_mean(painted(""), settings_of("path_tracing"), radiance(1), 1e-3);
}

TEST(VertexColours, MeetTheSameVerticesInMirroredInstances) {
    // The mirror exchanges two corners. The axis has the same barycentrics of the same vertices.
    test::expect_mean(painted(colours({0, 1, 0}), "", R"({"scale": [-1, 1, 1]},)"),
                      settings_of("path_tracing"), radiance(0.3), 1e-3);
    test::expect_mean(painted(colours({0, 1, 0}), "", R"({"scale": [1, 1, -1]},)"),
                      settings_of("path_tracing"), radiance(0.3), 1e-3);
}

TEST(VertexColours, GiveTheSameBitsHoweverPathsAreTraced) {
    test::expect_same_bits_however_traced(painted(colours({0.1, 0.6, 0.9})));
}

TEST(VertexColours, CanBeEditedInASession) {
    const RenderSettings settings = settings_of("path_tracing");
    Scene scene = painted(colours({0.1, 0.6, 0.9}));
    RenderSession session(scene, settings, device());
    const std::vector<int64_t> first = film_words(session, 4);
    const Scene white = painted("");
    session.update(white);
    const std::vector<int64_t> plain = film_words(session, 4);
    EXPECT_EQ(plain, film_words(white, settings));
    EXPECT_NE(plain, first);
    session.update(scene);
    EXPECT_EQ(film_words(session, 4), first);
    scene.set_property("wall.reflectance", "0.25,0.25,0.25");
    scene.update(0);
    session.update(scene);
    EXPECT_EQ(film_words(session, 4), film_words(scene, settings));
}

TEST(VertexColours, CostScenesWithoutThemNothing) {
    const Scene scene = painted(colours({0.1, 0.6, 0.9}));
    const CompiledScene with = compile_scene(scene, {});
    EXPECT_TRUE(with.features.has(Feature::vertex_colours));
    EXPECT_EQ(with.triangle_colours.size(), 1u);
    // The colours alone, which no texture shows, compile nothing.
    const Scene unused = parse_scene_json(
        R"({"version": 1, "film": {"width": 4, "height": 4}, "nodes": [
        {"name": "camera", "camera": {"type": "pinhole", "fov": 5, "fov_axis": "x"}},
        {"name": "wall", "geometry": {"type": "mesh", "polygons": [[0, 1, 2]],
            "vertices": [[-5, 1, 0], [5, -3, 0], [-1, 1.4, 0]])" +
            colours({0, 0, 0}) +
            R"(}, "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]}}]})",
        "in.json", "in", testing::TempDir());
    const CompiledScene without = compile_scene(unused, {});
    EXPECT_FALSE(without.features.has(Feature::vertex_colours));
    EXPECT_TRUE(without.triangle_colours.empty());
}

/// Returns the message of the error that the scene gives.
template <typename Make>
std::string error_of(const Make &make) {
    try {
        make();
    } catch (const Error &error) {
        return error.what();
    }
    return "";
}

TEST(VertexColours, SayWhatIsWrong) {
    const auto expect = [](const std::string &reds, const std::string &keys, const char *message) {
        const std::string error = error_of([&] { painted(reds, keys); });
        EXPECT_NE(error.find(message), std::string::npos) << error;
    };
    expect(R"(, "colours": [[1, 1, 1]])", "",
           "1 colours for 3 vertices; give one per vertex, or none");
    expect(colours({0, 2, 0}), "", "/geometry/colours/1/0");
    expect(colours({0, 1, -0.5}), "", "/geometry/colours/2/0");
    for (const std::string key : {"opacity", "emission", "normal_map"}) {
        const std::string message = "texture 'wall." + key + "_texture' of its " +
                                    (key == "normal_map" ? "normals" : key) + " has vertex_colours";
        expect("",
               (key == "emission" ? R"(, "emission": [1, 1, 1])" : "") + (R"(, ")" + key) +
                   R"(_texture": {"vertex_colours": true})",
               message.c_str());
    }
    expect("", R"(, "opacity_texture": {"filter": "nearest"})",
           "a texture needs a file and its encoding, vertex_colours, or both");
    expect("", R"(, "opacity_texture": {"vertex_colours": true, "encoding": "linear"})",
           "a texture needs a file and its encoding, vertex_colours, or both");
}

}  // namespace
}  // namespace rtrays
