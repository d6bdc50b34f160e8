// SPDX-License-Identifier: MIT
#include "reference/shading.h"

#include <gtest/gtest.h>

#include "reference/tests/statistics.h"
#include "reference/tests/test_materials.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/statistics.h"

namespace rtrays::reference {
namespace {

const std::array<Vec3, 4> floor_corners{Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(1, 0, 0)};

/// Returns a floor that faces up, with the same shading normal everywhere.
TestScene floor_with_normal(const Vec3 &normal) {
    TestScene scene;
    scene.add_quad(floor_corners, scene.add_material(Rgb::Constant(0.5f)));
    scene.set_normals(std::vector<Vec3>(4, normal));
    return scene;
}

Shading shade(const TestScene &scene, const Vec3 &wo, double x = 0.25, double z = 0.5) {
    const Geometry geometry(scene.meshes, scene.shapes);
    SurfacePoint hit;
    EXPECT_TRUE(geometry.intersect({Vec3(x, 1, z), -Vec3::UnitY()}, Coherence::coherent, hit));
    return make_shading(geometry, hit, wo, true);
}

TEST(Shading, normals_are_interpolated_and_turned_to_the_front) {
    const Vec3 left = Vec3(-1, 1, 0).normalized(), right = Vec3(1, 1, 0).normalized();
    TestScene scene;
    scene.add_quad(floor_corners, scene.add_material(Rgb::Constant(0.5f)));
    scene.set_normals({left, left, right, right});
    const Shading quarter = shade(scene, Vec3::UnitY());
    EXPECT_TRUE(quarter.bent);
    EXPECT_NEAR((quarter.frame.z() - (0.75 * left + 0.25 * right).normalized()).norm(), 0.0, 1e-6);
    EXPECT_EQ(quarter.geometric_normal, Vec3::UnitY());
    scene.meshes.normal = {-left.cast<float>(), -left.cast<float>(), -right.cast<float>(),
                           -right.cast<float>()};
    EXPECT_NEAR((shade(scene, Vec3::UnitY()).frame.z() - quarter.frame.z()).norm(), 0.0, 1e-12);
    // The frame is the same from below, because z is the front.
    EXPECT_NEAR((shade(scene, -Vec3::UnitY()).frame.z() - quarter.frame.z()).norm(), 0.0, 1e-12);
}

TEST(Shading, sides_that_disagree_give_way_to_the_geometric_normal_or_to_nothing) {
    const TestScene scene = floor_with_normal(Vec3(1, 1, 0).normalized());
    // Above the floor, behind the shading normal.
    const Vec3 behind = Vec3(-1, 0.5, 0).normalized();
    EXPECT_FALSE(shade(scene, behind).bent);
    EXPECT_EQ(shade(scene, behind).frame.z(), Vec3::UnitY());
    const Shading seen = shade(scene, Vec3::UnitY());
    EXPECT_FALSE(seen.agrees(behind, seen.frame.to_local(behind)));
    const Vec3 under = Vec3(1, -0.5, 0).normalized();  // below the floor, before the shading normal
    EXPECT_FALSE(seen.agrees(under, seen.frame.to_local(under)));
    EXPECT_TRUE(seen.agrees(Vec3::UnitY(), seen.frame.to_local(Vec3::UnitY())));
    EXPECT_TRUE(seen.agrees(-Vec3::UnitY(), seen.frame.to_local(-Vec3::UnitY())));
    EXPECT_FALSE(shade(floor_with_normal(Vec3::Zero()), Vec3::UnitY()).frame.z().hasNaN());
}

TEST(Shading, tangents_follow_u_and_else_the_first_edge) {
    TestScene scene = floor_with_normal(Vec3(0.2, 1, 0).normalized());
    scene.set_uv({{0, 0}, {0, 2}, {3, 2}, {3, 0}});  // u along x, v along z
    const Shading mapped = shade(scene, Vec3::UnitY());
    EXPECT_NEAR((mapped.frame.x() - Vec3(1, -0.2, 0).normalized()).norm(), 0.0, 1e-6);
    EXPECT_NEAR((mapped.at.uv - Eigen::Vector2d(0.75, 1.0)).norm(), 0.0, 1e-6);
    scene.meshes.uv.assign(4, {1.0f, 1.0f});
    EXPECT_NEAR((shade(scene, Vec3::UnitY()).frame.x() - Vec3::UnitZ()).norm(), 0.0, 1e-6);
    scene.meshes.has_uv = {0};
    EXPECT_NEAR((shade(scene, Vec3::UnitY()).frame.x() - Vec3::UnitZ()).norm(), 0.0, 1e-6);
}

TEST(Shading, colours_are_interpolated_between_vertices) {
    TestScene scene;
    scene.add_quad(floor_corners, scene.add_material(Rgb::Constant(0.5f)));
    EXPECT_TRUE((shade(scene, Vec3::UnitY()).at.vertex_colour == 1.0).all());
    // Linear over the floor, so that its diagonal does not matter: x, z and 1 - x.
    scene.set_colours({Rgb(0, 0, 1), Rgb(0, 1, 1), Rgb(1, 1, 0), Rgb(1, 0, 0)});
    for (const auto &[x, z] : {std::pair(0.25, 0.5), std::pair(0.75, 0.125)}) {
        const Spectrum colour = shade(scene, Vec3::UnitY(), x, z).at.vertex_colour;
        EXPECT_LT((colour - Spectrum(x, z, 1.0 - x)).abs().maxCoeff(), 1e-6);
    }
}

TEST(Shading, a_closed_box_stays_dark_inside_whatever_its_normals) {
    TestScene scene;
    const uint32_t grey = scene.add_material(Rgb::Constant(0.9f));
    scene.add_box({-1, -1, -1}, {1, 1, 1}, true, grey);
    Rng rng(91, 0, 0);
    std::vector<Vec3> normals;
    for (int i = 0; i < 8; ++i) {
        normals.push_back(
            Vec3(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5).normalized());
    }
    scene.set_normals(normals);
    scene.add_box({-3, -3, -3}, {3, 3, 3}, true, grey, Rgb::Ones());
    scene.set_camera(Vec3::Zero(), {0.3, 0.2, 1}, Vec3::UnitY(), 2.0);
    auto renderer = scene.renderer(small_settings(16, 92));
    renderer.render(0, 256);
    EXPECT_EQ(image_mean(renderer.develop(), "R").mean, 0.0);
}

/// Returns the radiance of a floor in a black box that emits 1. It is the albedo of the material,
/// less the losses due to the bent normal.
BlockMean floor_in_furnace(const std::vector<BxdfComponent> &components, const Vec3 &normal,
                           Strategies strategies, uint64_t spp) {
    TestScene scene;
    scene.add_quad({Vec3(-9, 0, -9), Vec3(-9, 0, 9), Vec3(9, 0, 9), Vec3(9, 0, -9)},
                   scene.add_material(components));
    scene.set_normals(std::vector<Vec3>(4, normal));
    scene.add_box(Vec3::Constant(-20), Vec3::Constant(20), true, scene.add_material(Rgb::Zero()),
                  Rgb::Ones());
    scene.set_camera({3, 5, 1}, {0, 0, 0}, Vec3::UnitY(), 1e-3);
    ReferenceSettings settings =
        small_settings(4, 93 + static_cast<uint64_t>(strategies), strategies);
    settings.max_depth = 1;
    auto renderer = scene.renderer(settings);
    renderer.render(0, spp);
    return image_mean(renderer.develop(), "R");
}

TEST(Shading, a_lambert_floor_loses_what_its_bent_normal_sends_below) {
    // The share (1 - cos t) / 2 of the cosine lobe around a normal tilted by t is below the plane.
    const double tilt = 0.4;
    const Vec3 normal(std::sin(tilt), std::cos(tilt), 0.0);
    const double expected = 0.5 * 0.5 * (1.0 + std::cos(tilt));
    std::vector<Comparison> suite;
    for (const auto &[name, strategies] : strategies_names) {
        const BlockMean mean = floor_in_furnace({lambert(0.5)}, normal, strategies, 1 << 14);
        suite.push_back({name, normal_p_value((mean.mean - expected) / std::sqrt(mean.variance))});
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(Shading, rough_materials_look_the_same_to_all_strategies) {
    std::vector<Comparison> suite;
    for (const TestMaterial &material : rough_materials()) {
        const Vec3 normal = Vec3(0.1, 1.0, -0.1).normalized();
        const BlockMean hits =
            floor_in_furnace(material.components, normal, Strategies::implicit_only, 4096);
        const BlockMean both = floor_in_furnace(material.components, normal, Strategies::mis, 4096);
        const double z = (hits.mean - both.mean) / std::sqrt(hits.variance + both.variance);
        suite.push_back({material.name, normal_p_value(z)});
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

}  // namespace
}  // namespace rtrays::reference
