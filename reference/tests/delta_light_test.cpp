// SPDX-License-Identifier: MIT
// Point, spot and directional lights: the radiance of a floor against closed forms, seen by a
// narrow camera.
#include <gtest/gtest.h>

#include "reference/tests/statistics.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"
#include "renderer/base/statistics.h"

namespace rtrays::reference {
namespace {

using Kind = LightArrays::Kind;

constexpr double albedo = 0.5;

/// Returns a transform to `position` whose -z axis is `axis`.
Eigen::Matrix4d aimed(const Vec3 &position, const Vec3 &axis) {
    Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
    transform.topLeftCorner<3, 3>() =
        Eigen::Quaterniond::FromTwoVectors(-Vec3::UnitZ(), axis.normalized()).toRotationMatrix();
    transform.topRightCorner<3, 1>() = position;
    return transform;
}

/// Returns a floor at y = 0, seen at `point` by a camera with a field of view of a hundredth of a
/// degree.
TestScene floor_seen_at(const Vec3 &point) {
    TestScene scene;
    scene.add_quad({Vec3(-10, 0, -10), Vec3(-10, 0, 10), Vec3(10, 0, 10), Vec3(10, 0, -10)},
                   scene.add_material(Rgb::Constant(albedo)));
    scene.set_camera({6.0, 1.5, 0.3}, point, Vec3::UnitY(), 2e-4);
    return scene;
}

/// Returns the measured irradiance of the floor over the expected one.
double relative_irradiance(const TestScene &scene, double expected, Strategies strategies,
                           uint64_t spp = 64) {
    ReferenceSettings settings = small_settings(4, 121, strategies);
    settings.max_depth = 1;
    auto renderer = scene.renderer(settings);
    renderer.render(0, spp);
    return image_mean(renderer.develop(), "G").mean * pi / albedo / expected;
}

const Vec3 point(0.7, 0.0, -0.4);

TEST(DeltaLights, a_point_falls_off_with_the_square_of_the_distance) {
    for (const double height : {0.1, 1.0, 30.0}) {
        TestScene scene = floor_seen_at(point);
        scene.add_light(Kind::point, Rgb::Constant(7.0f));
        const Vec3 position(0.2, height, 0.3);
        scene.lights.world_from_light[0] = aimed(position, Vec3::UnitX());
        const double distance = (position - point).norm();
        const double expected = 7.0 * height / (distance * distance * distance);
        EXPECT_NEAR(relative_irradiance(scene, expected, Strategies::mis), 1.0, 1e-4);
        EXPECT_NEAR(relative_irradiance(scene, expected, Strategies::explicit_only), 1.0, 1e-4);
        EXPECT_EQ(relative_irradiance(scene, expected, Strategies::implicit_only), 0.0);
    }
}

TEST(DeltaLights, a_spot_falls_linearly_with_the_angle) {
    const Vec3 position(0.0, 2.0, 0.0);
    for (const double angle : {0.0, 0.29, 0.4, 0.5, 0.59, 0.61}) {
        TestScene scene = floor_seen_at(point);
        scene.add_light(Kind::spot, Rgb::Constant(7.0f));
        const Vec3 to_point = (point - position).normalized();
        const Vec3 axis = Eigen::AngleAxisd(angle, to_point.unitOrthogonal()) * to_point;
        scene.lights.world_from_light[0] = aimed(position, axis);
        scene.lights.inner_angle[0] = 0.3;
        scene.lights.outer_angle[0] = 0.6;
        const double share = angle <= 0.3 ? 1.0 : std::max(0.0, (0.6 - angle) / 0.3);
        const double distance = (position - point).norm();
        const double full = 7.0 * 2.0 / (distance * distance * distance);
        EXPECT_NEAR(relative_irradiance(scene, full, Strategies::mis), share, 1e-3) << angle;
    }
}

TEST(DeltaLights, directional_light_is_given_as_irradiance) {
    TestScene scene = floor_seen_at(point);
    scene.add_light(Kind::directional, Rgb::Constant(3.0f));
    const Vec3 axis = Vec3(0.3, -0.8, 0.2).normalized();
    scene.lights.world_from_light[0] = aimed({100, -200, 300}, axis);  // the position has no effect
    EXPECT_NEAR(relative_irradiance(scene, -3.0 * axis.y(), Strategies::mis), 1.0, 1e-4);
    // An occluder casts a shadow from any distance.
    scene.add_quad({Vec3(-9, 0, -9), Vec3(-9, 0, 9), Vec3(9, 0, 9), Vec3(9, 0, -9)}, 0);
    for (size_t i = 4; i < 8; ++i) {
        scene.meshes.position[i] += (point - 1000.0 * axis).cast<float>();
    }
    EXPECT_EQ(relative_irradiance(scene, 1.0, Strategies::mis), 0.0);
}

TEST(DeltaLights, several_are_chosen_without_bias) {
    TestScene scene = floor_seen_at(point);
    double expected = 0.0;
    for (int i = 0; i < 5; ++i) {
        const Vec3 position(i - 2.0, 1.0 + i, 0.5 * i);
        // The first one is black.
        scene.add_light(Kind::point, Rgb::Constant(static_cast<float>(i)));
        scene.lights.world_from_light.back() = aimed(position, Vec3::UnitX());
        const double distance = (position - point).norm();
        expected += i * position.y() / (distance * distance * distance);
    }
    ReferenceSettings settings = small_settings(4, 122);
    settings.max_depth = 1;
    auto renderer = scene.renderer(settings);
    renderer.render(0, 1 << 14);
    const BlockMean mean = image_mean(renderer.develop(), "G");
    const double z = (mean.mean - expected * albedo / pi) / std::sqrt(mean.variance);
    EXPECT_GT(normal_p_value(z), 0.001);
    EXPECT_LT(std::sqrt(mean.variance) / mean.mean, 0.003);
}

TEST(DeltaLights, refuse_parameters_out_of_range) {
    TestScene scene = floor_seen_at(point);
    scene.add_light(Kind::spot, Rgb::Ones());
    EXPECT_THROW(scene.renderer(small_settings(4, 1)), Error);  // missing angles
    scene.lights.kind[0] = Kind::environment;
    EXPECT_THROW(scene.renderer(small_settings(4, 1)), Error);  // missing image
    scene.lights.kind[0] = Kind::diffuse_area;
    scene.lights.shape[0] = 3;
    EXPECT_THROW(scene.renderer(small_settings(4, 1)), Error);
}

}  // namespace
}  // namespace rtrays::reference
