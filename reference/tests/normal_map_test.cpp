// SPDX-License-Identifier: MIT
#include "reference/normal_map.h"

#include <gtest/gtest.h>

#include "reference/tests/statistics.h"
#include "reference/tests/test_scenes.h"

namespace rtrays::reference {
namespace {

/// A texture of float texels, row by row from the top.
TextureArrays texture_of(int width, int height, std::vector<float> texels) {
    auto image = std::make_shared<TextureImage>();
    image->width = width;
    image->height = height;
    image->floats = std::move(texels);
    TextureArrays textures;
    textures.name = {"map"};
    textures.image = {image};
    textures.filter = {TextureArrays::Filter::bilinear};
    textures.wrap = {TextureArrays::Wrap::repeat};
    textures.uv_scale = {{1, 1}};
    textures.uv_offset = {{0, 0}};
    return textures;
}

NormalTilt normals(const Vec3 &n, NormalMap map = {}) {
    map.kind = NormalMap::Kind::normals;
    map.texture = 0;
    const auto texel = [](double c) { return static_cast<float>(0.5 + 0.5 * c); };
    return {map, texture_of(1, 1, {texel(n.x()), texel(n.y()), texel(n.z())})};
}

/// The plane z = 0 with u = x and v = y.
Parametrization plane() {
    return {Vec3::UnitZ(), Vec3::UnitX(), {0.5, 0.5}, true, Vec3::UnitY()};
}

const Vec3 up = Vec3::UnitZ();

TEST(NormalTilt, texels_are_normals_in_the_frame_of_the_surface) {
    const Vec3 n(0.3, -0.2, 0.5);
    EXPECT_LT((normals(n).normal(plane(), up) - n.normalized()).norm(), 1e-6);
    NormalMap map;
    map.scale = 2;
    EXPECT_LT((normals(n, map).normal(plane(), up) - Vec3(0.6, -0.4, 0.5).normalized()).norm(),
              1e-6);
    Parametrization mirrored = plane();
    mirrored.tangent = -Vec3::UnitX();
    EXPECT_LT((normals(n).normal(mirrored, up) - Vec3(-0.3, 0.2, 0.5).normalized()).norm(), 1e-6);
    map = {};
    map.follows_v = true;
    EXPECT_LT((normals(n, map).normal(mirrored, up) - Vec3(-0.3, -0.2, 0.5).normalized()).norm(),
              1e-6);
    EXPECT_EQ(normals(Vec3::Zero()).normal(plane(), up), up) << "no direction";
}

TEST(NormalTilt, heights_tilt_like_the_displaced_surface) {
    NormalMap map;
    map.kind = NormalMap::Kind::heights;
    map.texture = 0;
    map.scale = 0.5;
    const NormalTilt tilt(map, texture_of(2, 1, {0, 0, 0, 1, 1, 1}));
    // Slope 2 by u between the texel centres.
    EXPECT_LT((tilt.normal(plane(), up) - Vec3(-1, 0, 1).normalized()).norm(), 1e-6);
    Parametrization stretched = plane();
    stretched.tangent = {-4, 0, 0};
    EXPECT_LT((tilt.normal(stretched, up) - Vec3(0.25, 0, 1).normalized()).norm(), 1e-6);
    stretched.derivatives = false;
    EXPECT_EQ(tilt.normal(stretched, up), up);
}

TEST(NormalTilt, a_viewer_below_the_horizon_sees_the_reversed_tilt_or_the_surface) {
    const Vec3 n(0.8, 0, 0.2), reversed(-0.8, 0, 0.2);
    const NormalTilt tilt = normals(n);
    const Vec3 behind = Vec3(-1, 0, 0.1).normalized();
    EXPECT_LT((tilt.normal_for(plane(), up, up) - n.normalized()).norm(), 1e-6);
    EXPECT_LT((tilt.normal_for(plane(), up, behind) - reversed.normalized()).norm(), 1e-6);
    EXPECT_LT((tilt.normal_for(plane(), up, -behind) - reversed.normalized()).norm(), 1e-6);
    EXPECT_LT((tilt.normal_for(plane(), up, -up) - n.normalized()).norm(), 1e-6);
    NormalMap map;
    map.mirrored_back = true;
    EXPECT_LT((normals(n, map).normal_for(plane(), up, -up) - reversed.normalized()).norm(), 1e-6);
    EXPECT_EQ(normals({0.8, 0, -0.2}).normal_for(plane(), up, up), up) << "into the surface";
}

TEST(NormalTilt, shadowing_is_that_of_ggx) {
    const Vec3 n = Vec3(0.6, 0, 0.8), light = Vec3(0.3, 0.4, 0.25).normalized();
    const double expected = 2 / (1 + std::sqrt(1 + 0.5625 / 8 * 4));
    EXPECT_NEAR(normals(n).shadowing(n, up, light), expected, 1e-12);
    EXPECT_NEAR(normals(n).shadowing(n, up, -light), expected, 1e-12);
    EXPECT_NEAR(normals(n).shadowing(Vec3(1, 0, 1e-9).normalized(), up, light),
                2 / (1 + std::sqrt(5.0)), 1e-9);
    NormalMap map;
    map.shadowing = false;
    EXPECT_EQ(normals(n, map).shadowing(n, up, light), 1.0);
}

// A Lambert floor of reflectance 1/2 in a furnace loses what the tilted normal sends below.
TEST(NormalTilt, a_floor_in_a_furnace_loses_what_goes_below_the_surface) {
    TestScene scene;
    const uint32_t grey = scene.add_material(Rgb::Constant(0.5f));
    scene.add_quad({Vec3(-9, 0, -9), Vec3(-9, 0, 9), Vec3(9, 0, 9), Vec3(9, 0, -9)}, grey);
    scene.set_uv({{0, 0}, {0, 1}, {1, 1}, {1, 0}});
    scene.add_box(Vec3::Constant(-20), Vec3::Constant(20), true, scene.add_material(Rgb::Zero()),
                  Rgb::Ones());
    scene.textures = texture_of(1, 1, {0.8f, 0.5f, 0.9f});
    scene.materials.normal_map.resize(scene.materials.name.size());
    scene.materials.normal_map[grey] = {NormalMap::Kind::normals, 0, 1, false, false, false};
    scene.set_camera({3, 5, 1}, {0, 0, 0}, Vec3::UnitY(), 1e-3);
    ReferenceSettings settings = small_settings(4, 97);
    settings.max_depth = 1;
    auto renderer = scene.renderer(settings);
    renderer.render(0, 1 << 14);
    const BlockMean mean = image_mean(renderer.develop(), "R");
    EXPECT_NEAR(mean.mean, 0.5 * 0.5 * (1 + 0.8), 4 * std::sqrt(mean.variance));
}

}  // namespace
}  // namespace rtrays::reference
