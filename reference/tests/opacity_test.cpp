// SPDX-License-Identifier: MIT
// Surfaces that are not opaque: the share of rays that they stop, and a closed form.
#include "reference/opacity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/geometry.h"
#include "reference/tests/test_scenes.h"

namespace rtrays::reference {
namespace {

constexpr int rays = 100000;

uint32_t add_material(TestScene &scene, const MaterialOpacity &opacity, float albedo = 0.5f) {
    const uint32_t material = scene.add_material(Rgb::Constant(albedo));
    scene.materials.opacity.resize(material + 1);
    scene.materials.opacity[material] = opacity;
    return material;
}

MaterialOpacity constant(double value) {
    MaterialOpacity opacity;
    opacity.value = value;
    return opacity;
}

Geometry geometry_of(const TestScene &scene) {
    return {scene.meshes, scene.shapes, make_opacities(scene.materials, scene.textures)};
}

/// Adds a square of half side 2 at height `z`.
void add_sheet(TestScene &scene, double z, const MaterialOpacity &opacity, float albedo = 0.5f) {
    scene.add_quad({Vec3(-2, -2, z), Vec3(2, -2, z), Vec3(2, 2, z), Vec3(-2, 2, z)},
                   add_material(scene, opacity, albedo));
}

/// Expects a binomial count with probability p, within 6 standard deviations.
void expect_share(int count, double p) {
    EXPECT_NEAR(count, rays * p, 6 * std::sqrt(rays * p * (1 - p)) + 1e-9) << "p = " << p;
}

/// Counts rays from (x, y, 3) down that are stopped by anything.
int stopped(const Geometry &geometry, double x, double y) {
    Rng rng(1, 2, 3);
    int count = 0;
    for (int i = 0; i < rays; ++i) {
        const uint64_t key = rng.next_bits();
        SurfacePoint hit;
        const Vec3 from(x, y, 3);
        const bool hits = geometry.intersect({from, -Vec3::UnitZ()}, Coherence::coherent, hit, key);
        EXPECT_EQ(geometry.occluded({from, -Vec3::UnitZ()}, key), hits);
        EXPECT_EQ(geometry.occluded(from, Vec3(x, y, -3), key), hits);
        count += hits;
    }
    return count;
}

TEST(Opacity, is_the_share_of_rays_that_a_triangle_stops) {
    for (const double opacity : {0.0, 0.25, 0.9, 1.0}) {
        TestScene scene;
        add_sheet(scene, 0, constant(opacity));
        expect_share(stopped(geometry_of(scene), 0.3, 0.4), opacity);
    }
}

TEST(Opacity, of_several_sheets_is_independent) {
    TestScene scene;
    for (int i = 0; i < 5; ++i) {
        add_sheet(scene, 0.1 * i, constant(0.2));
    }
    add_sheet(scene, 0, constant(0.2));  // coincides with the first
    expect_share(stopped(geometry_of(scene), 0.3, 0.4), 1 - std::pow(0.8, 6));
}

TEST(Opacity, of_a_shape_counts_at_each_hit) {
    for (const auto &[kind, share] :
         {std::pair(ShapeArrays::Kind::sphere, 0.75), std::pair(ShapeArrays::Kind::plane, 0.5)}) {
        TestScene scene;
        scene.add_shape(kind, placed(Vec3::Zero(), 1), add_material(scene, constant(0.5)));
        expect_share(stopped(geometry_of(scene), 0.3, 0.4), share);
    }
}

TEST(Opacity, of_a_texture_is_looked_up_at_the_hit) {
    auto image = std::make_shared<TextureImage>();
    image->width = 2;
    image->height = 1;
    image->floats = {0.25f, 0.25f, 0.25f, 1, 0, 0};
    TestScene scene;
    scene.textures = {
        {"t"},        {image},     {TextureArrays::Filter::nearest}, {TextureArrays::Wrap::clamp},
        {{1.0, 1.0}}, {{0.0, 0.0}}};
    MaterialOpacity textured;
    textured.texture = 0;
    add_sheet(scene, 0, textured);
    scene.set_uv({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    expect_share(stopped(geometry_of(scene), -1, 0.4), 0.25);
    expect_share(stopped(geometry_of(scene), 1, 0.4), 0.2126);
    scene.materials.opacity[0].cutoff = 0.25;
    EXPECT_EQ(stopped(geometry_of(scene), -1, 0.4), rays);
    EXPECT_EQ(stopped(geometry_of(scene), 1, 0.4), 0);
}

TEST(Opacity, mixes_a_sheet_with_what_is_behind_it) {
    // Under a dome of radiance 1, on both sides, a sheet of albedo r has the radiance r.
    TestScene scene;
    add_sheet(scene, 0, constant(0.7), 0.2f);
    scene.add_light(LightArrays::Kind::dome, Rgb::Ones());
    scene.set_camera({0, 0, 1}, {0, 0, 0}, Vec3::UnitY(), 0.5);
    ReferenceRenderer renderer = scene.renderer(small_settings(16, 7));
    renderer.render(0, 256);
    const Image image = renderer.develop();
    double mean = 0, variance = 0;
    for (size_t i = 0; i < 256; ++i) {
        mean += static_cast<double>(image.channel("R")[i]) / 256;
        variance += static_cast<double>(image.channel("variance.R")[i]) / (256 * 256);
    }
    EXPECT_NEAR(mean, 0.7 * 0.2 + 0.3, 5 * std::sqrt(variance));
    EXPECT_LT(std::sqrt(variance), 0.01);
}

}  // namespace
}  // namespace rtrays::reference
