// SPDX-License-Identifier: MIT
// Renders components that a texture mixes: closed forms for camera and light paths, and the same
// bits for every pipeline.
#include <gtest/gtest.h>

#include <fstream>

#include "renderer/import/json/scene_json.h"
#include "renderer/testing/errors.h"
#include "renderer/testing/session_films.h"

namespace rtrays {
namespace {

using test::film_words;
using test::settings_of;

constexpr double pi = 3.14159265358979323846;

/// Writes an image of one texel.
void write_texel(const std::string &name, const std::string &ending, float r, float g, float b) {
    std::ofstream file(testing::TempDir() + name + ending, std::ios::binary);
    const float texel[] = {r, g, b};
    file << "PF\n1 1\n-1.0\n";
    file.write(reinterpret_cast<const char *>(texel), sizeof texel);
}

/// A wall of these components, lit along its normal with irradiance 2. The textures `half` and
/// `coloured` have the luminances 1/2 and 0.2126 * 0.8 + 0.7152 * 0.25.
Scene wall(const std::string &components) {
    write_texel("half", ".pfm", 0.5f, 0.5f, 0.5f);
    write_texel("coloured", ".pfm", 0.8f, 0.25f, 0);
    return parse_scene_json(
        R"({"version": 1, "film": {"width": 16, "height": 16},
        "textures": {"half": {"file": "half.pfm", "encoding": "linear"},
                     "coloured": {"file": "coloured.pfm", "encoding": "linear"}}, "nodes": [
        {"name": "camera", "camera": {"type": "pinhole", "fov": 20, "fov_axis": "x"}},
        {"name": "sun", "light": {"type": "directional", "irradiance": [2, 2, 2]}},
        {"name": "wall", "geometry": {"type": "rectangle"}, "transform": [{"translate": [0, 0, -2]}],
         "material": {"type": "composite", "components": [)" +
            components + "]}}]}",
        "in.json", "in", testing::TempDir());
}

std::string lambert(const std::string &weight, const std::string &keys) {
    return R"({"bxdf": "lambert", "weight": [)" + weight + "]" + keys + "}";
}

/// Keys of a component with that share, and those of the rest.
std::string share(const std::string &keys) {
    return ", \"mix_inverted\": false" + keys;
}
std::string rest(const std::string &keys) {
    return ", \"mix_inverted\": true" + keys;
}

double radiance(double reflectance) {
    return reflectance * 2 / pi;
}

TEST(Mixtures, AreWeightedByTheLuminanceOfTheTexture) {
    const std::string keys = R"(, "mix": 0.8, "mix_texture": "coloured")";
    const double mix = 0.8 * (0.2126 * 0.8 + 0.7152 * 0.25);
    const Scene scene =
        wall(lambert("0.9, 0, 0", share(keys)) + ", " + lambert("0.3, 0, 0", rest(keys)));
    for (const char *algorithm : {"path_tracing", "light_tracing", "bdpt", "truncated_bdpt"}) {
        test::expect_mean(scene, settings_of(algorithm), radiance(0.9 * mix + 0.3 * (1 - mix)),
                          1e-3);
    }
}

TEST(Mixtures, WithoutTextureAreNumbers) {
    const std::string keys = R"(, "mix": 0.25)";
    test::expect_mean(
        wall(lambert("0.8, 0, 0", share(keys)) + ", " + lambert("0.4, 0, 0", rest(keys))),
        settings_of("path_tracing"), radiance(0.25 * 0.8 + 0.75 * 0.4), 1e-3);
}

TEST(Mixtures, DoNotChangeTheColourThatANonlinearBaseTakes) {
    // Half of a base under a coat is half of its radiance, although its colour is not linear.
    const auto base = [](const std::string &keys) {
        return R"({"bxdf": "coated_lambert", "weight": [0.9, 0.9, 0.9], "eta": 1.5,
                   "nonlinear": true)" +
               keys + "}";
    };
    const RenderSettings settings = settings_of("path_tracing");
    const auto red = [&](const Scene &scene) {
        RenderSession session(scene, settings, test::device());
        session.render(0, 16);
        return static_cast<double>(session.develop().channel("R")[100]);
    };
    const double all = red(wall(base("")));
    EXPECT_GT(all, 0.1);
    EXPECT_NEAR(red(wall(base(share(R"(, "mix_texture": "half")")))), 0.5 * all, 1e-5 * all);
}

TEST(Mixtures, GiveTheSameBitsHoweverPathsAreTraced) {
    const std::string keys = R"(, "mix_texture": "coloured")";
    const Scene scene = wall(lambert("0.9, 0, 0", share(keys)) +
                             R"(, {"bxdf": "microfacet_reflection", "alpha": 0.4,
                                   "weight": [0.8, 0.8, 0.8])" +
                             rest(keys) + "}");
    test::expect_same_bits_however_traced(scene);
}

TEST(Mixtures, SumToAtMostOneForEveryTexel) {
    const std::string keys = R"(, "mix_texture": "half")";
    // Each is 1 where the texture is 0 and where it is brightest.
    wall(lambert("1, 1, 1", share(keys)) + ", " + lambert("1, 1, 1", rest(keys)));
    // Both grow with the texture.
    const auto both = [&](const std::string &weight) {
        return lambert(weight, share(keys)) + ", " + lambert(weight, share(keys));
    };
    wall(both("1, 1, 1"));
    expect_input_error("add up to 1.5",
                       [&] { wall(both("1, 1, 1") + ", " + lambert("0.5, 0.5, 0.5", "")); });
    // The rest is largest where the texture is black.
    expect_input_error("add up to 1.2", [&] {
        wall(lambert("0.6, 0.6, 0.6", rest(keys)) + ", " + lambert("0.6, 0.6, 0.6", rest(keys)));
    });
    write_texel("bright", ".pfm", 2, 2, 2);
    expect_input_error("the mix 0.6 times the brightest texel of its texture, 2, exceeds 1", [&] {
        wall(lambert(
            "0.1, 0.1, 0.1",
            R"(, "mix": 0.6, "mix_texture": {"file": "bright.pfm", "encoding": "linear"})"));
    });
    expect_input_error("of its mixture has vertex_colours", [&] {
        wall(lambert("0.1, 0.1, 0.1", R"(, "mix_texture": {"vertex_colours": true})"));
    });
}

}  // namespace
}  // namespace rtrays
