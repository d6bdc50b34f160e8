// SPDX-License-Identifier: MIT
// Renders surfaces with maps of normals and heights: closed forms for camera and light paths, and
// the same bits for every pipeline and after edits.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "renderer/import/json/scene_json.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::device;
using test::film_words;
using test::settings_of;

constexpr double pi = 3.14159265358979323846;

/// Writes an image of float texels, row by row from the top.
void write_pfm(const std::string &name, int width, std::vector<float> texels) {
    std::ofstream file(testing::TempDir() + name, std::ios::binary);
    const size_t row = 3 * static_cast<size_t>(width);
    file << "PF\n" << width << " " << texels.size() / row << "\n-1.0\n";
    for (size_t first = texels.size(); first > 0; first -= row) {  // rows from below
        file.write(reinterpret_cast<const char *>(&texels[first - row]),
                   static_cast<std::streamsize>(row * sizeof(float)));
    }
}

/// A wall of reflectance 1/2 at z = -2 before the camera, lit along z turned by these degrees about
/// y with irradiance 2.
Scene wall(const std::string &keys, double degrees, const std::string &transform = "") {
    return parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16}, "nodes": [
        {"name": "camera", "camera": {"type": "pinhole", "fov": 20, "fov_axis": "x"}},
        {"name": "sun", "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": )" +
            std::to_string(degrees) +
            R"(}}], "light": {"type": "directional", "irradiance": [2, 2, 2]}},
        {"name": "wall", "geometry": {"type": "rectangle"}, "transform": [)" +
            transform + R"({"translate": [0, 0, -2]}],
         "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5])" +
            keys + "}}]}",
        "in.json", "in", testing::TempDir());
}

void expect_mean(const Scene &scene, const char *algorithm, double expected) {
    test::expect_mean(scene, settings_of(algorithm), expected, 1e-4);
}

const std::string normals =
    R"(, "normal_map_texture": {"file": "normal.pfm", "encoding": "linear"})";

/// Writes a map of the normal (0.6, 0, 0.8).
void write_normal() {
    write_pfm("normal.pfm", 1, {0.8f, 0.5f, 0.9f});
}

/// Returns the radiance of the wall whose normal is tilted by `tilt`, both angles towards +x.
double radiance(double tilt, double light, bool shadows) {
    const double alpha2 = std::min(std::pow(std::tan(tilt), 2) / 8, 1.0);
    const double shadowing =
        shadows ? 2 / (1 + std::sqrt(1 + alpha2 * std::pow(std::tan(light), 2))) : 1;
    return 0.5 / pi * 2 * std::cos(tilt - light) * shadowing;
}

TEST(NormalMaps, TiltTheNormalForAllKindsOfPaths) {
    write_normal();
    const double tilt = std::asin(0.6);
    for (const char *algorithm : {"path_tracing", "light_tracing", "bdpt"}) {
        expect_mean(wall(normals, 60), algorithm, radiance(tilt, pi / 3, true));
    }
    expect_mean(wall(normals + R"(, "map_shadowing": false)", 60), "path_tracing",
                radiance(tilt, pi / 3, false));
    expect_mean(wall(normals, -30), "path_tracing", radiance(tilt, -pi / 6, true));
}

TEST(NormalMaps, FollowTheTransformOfTheirInstance) {
    write_normal();
    const double tilt = std::asin(0.6);
    // A scale changes neither the direction of dp/du nor that of the normal; a mirror turns dp/du.
    expect_mean(wall(normals, 60, R"({"scale": [0.8, 3, 5]},)"), "path_tracing",
                radiance(tilt, pi / 3, true));
    expect_mean(wall(normals, 30, R"({"scale": [-1, 1, 1]},)"), "path_tracing",
                radiance(-tilt, pi / 6, true));
    // The back is seen with dp/du to the left. What rises in front sinks behind: with -n, the
    // tilt is to the right again.
    const std::string turned = R"({"rotate": {"axis": [0, 1, 0], "degrees": 180}},)";
    expect_mean(wall(normals, 30, turned), "path_tracing", radiance(tilt, pi / 6, true));
    expect_mean(wall(normals + R"(, "map_mirrored_back": true)", 30, turned), "path_tracing",
                radiance(-tilt, pi / 6, true));
}

TEST(BumpMaps, TiltTheNormalByTheirSlope) {
    // From 0 to 1 between the centres of two texels: slope 2 by u, and u is half of x.
    write_pfm("heights.pfm", 2, {0, 0, 0, 1, 1, 1});
    const std::string heights =
        R"(, "bump_map": 0.5, "bump_map_texture": {"file": "heights.pfm", "encoding": "linear"})";
    // Beyond the outer texel centres the image repeats, so the wall is made wider than the view.
    const std::string wide = R"({"scale": [3, 1, 1]},)";
    const double tilt = -std::atan(0.5 * 2 / 6);  // the normal tilts against the slope
    expect_mean(wall(heights, 45, wide), "path_tracing", radiance(tilt, pi / 4, true));
}

TEST(NormalMaps, GiveTheSameBitsHoweverPathsAreTraced) {
    write_normal();
    test::expect_same_bits_however_traced(wall(normals, 60));
}

TEST(NormalMaps, CanBeEditedInASession) {
    write_normal();
    const RenderSettings settings = settings_of("path_tracing");
    Scene scene = wall(normals, 60);
    RenderSession session(scene, settings, device());
    const std::vector<int64_t> first = film_words(session, 4);
    std::vector<int64_t> last;
    for (const char *value : {"0", "-2", "1"}) {
        scene.set_property("wall.normal_map", value);
        scene.update(0);
        session.update(scene);
        last = film_words(session, 4);
        EXPECT_EQ(last, film_words(scene, settings)) << value;
    }
    EXPECT_EQ(last, first);
    // Without the map, triangles have no normals of vertices any more.
    const Scene plain = wall("", 60);
    session.update(plain);
    EXPECT_EQ(film_words(session, 4), film_words(plain, settings));
    session.update(scene);
    EXPECT_EQ(film_words(session, 4), first);
}

}  // namespace
}  // namespace rtrays
