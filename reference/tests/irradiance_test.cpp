// SPDX-License-Identifier: MIT
// Irradiance under a rectangular light against Lambert's closed form (1760; Arvo 1994, eq. 1), and
// under a dome through a ball.
#include <gtest/gtest.h>

#include "reference/tests/statistics.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/statistics.h"

namespace rtrays::reference {
namespace {

constexpr double radiance = 5.0;
constexpr double albedo = 0.5;
const std::array<Vec3, 4> light_corners{Vec3(-1, 2, -0.5), Vec3(1, 2, -0.5), Vec3(1, 2, 0.5),
                                        Vec3(-1, 2, 0.5)};

/// Returns E = Le / 2 sum theta_i (n . gamma_i) over the edges of the polygon as seen from `point`.
/// The full polygon must be above the horizon.
double polygon_irradiance(const Vec3 &point, const Vec3 &normal) {
    double sum = 0.0;
    for (size_t i = 0; i < 4; ++i) {
        const Vec3 a = (light_corners[i] - point).normalized();
        const Vec3 b = (light_corners[(i + 1) % 4] - point).normalized();
        const Vec3 cross = a.cross(b);
        const double angle = std::atan2(cross.norm(), a.dot(b));
        sum += angle * normal.dot(cross.normalized());
    }
    return 0.5 * radiance * std::abs(sum);
}

/// Returns a floor and the light above it. The camera looks at `point` with a field of view of a
/// hundredth of a degree.
TestScene floor_under_light(const Vec3 &point) {
    TestScene scene;
    const uint32_t material = scene.add_material(Rgb::Constant(albedo));
    scene.add_quad({Vec3(-10, 0, -10), Vec3(-10, 0, 10), Vec3(10, 0, 10), Vec3(10, 0, -10)},
                   material);
    scene.add_quad(light_corners, material, Rgb::Constant(radiance));
    scene.set_camera({6.0, 1.5, 0.3}, point, Vec3::UnitY(), 2e-4);
    return scene;
}

TEST(Irradiance, under_a_rectangle_is_lamberts) {
    std::vector<Comparison> suite;
    for (const Vec3 &point : {Vec3(0, 0, 0), Vec3(1.5, 0, 0.2), Vec3(-3, 0, 2), Vec3(0.9, 0, -4)}) {
        for (const auto &[name, strategies] : strategies_names) {
            ReferenceSettings settings = small_settings(4, 31, strategies);
            settings.max_depth = 1;
            auto renderer = floor_under_light(point).renderer(settings);
            renderer.render(0, 1 << 15);
            const BlockMean mean = image_mean(renderer.develop(), "G");
            const double expected = albedo / pi * polygon_irradiance(point, Vec3::UnitY());
            suite.push_back(
                {name, normal_p_value((mean.mean - expected) / std::sqrt(mean.variance))});
            if (strategies == Strategies::explicit_only) {
                EXPECT_NEAR(mean.mean / expected, 1.0, 0.004);  // and the error is small
            }
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(Irradiance, the_back_of_a_light_is_dark) {
    for (const auto &entry : strategies_names) {
        TestScene scene = floor_under_light(Vec3::Zero());
        // The camera sees the back of the light from above.
        scene.set_camera({0, 5, 0}, {0, 2, 0}, Vec3::UnitZ(), 1e-3);
        auto renderer = scene.renderer(small_settings(4, 32, entry.second));
        renderer.render(0, 64);
        EXPECT_EQ(image_mean(renderer.develop(), "R").mean, 0.0) << entry.first;
    }
}

TEST(Irradiance, the_front_of_a_light_shows_its_radiance) {
    for (const auto &entry : strategies_names) {
        TestScene scene = floor_under_light(Vec3::Zero());
        scene.set_camera({0, 1, 0}, {0, 2, 0}, Vec3::UnitZ(), 1e-3);
        ReferenceSettings settings = small_settings(4, 33, entry.second);
        // Excludes light from the floor that the surface of the light reflects.
        settings.max_depth = 1;
        auto renderer = scene.renderer(settings);
        renderer.render(0, 64);
        EXPECT_EQ(image_mean(renderer.develop(), "R").mean, radiance) << entry.first;
    }
}

// A plane under a dome, lit only through a ball. The point is at the distance s = 1 / sin(a) radii
// from the centre of the ball. Its light comes from two half cones of half angle a around the line
// to the centre, so E = L (2 a - sin 2 a).
TEST(Irradiance, of_a_plane_by_light_through_a_ball) {
    std::vector<Comparison> suite;
    for (const double distance : {0.5, 1.1, 2.0, 5.0}) {
        for (const auto &[name, strategies] : strategies_names) {
            TestScene scene;
            scene.add_shape(ShapeArrays::Kind::plane, Eigen::Matrix4d::Identity(),
                            scene.add_material(Rgb::Constant(albedo)));
            scene.add_light(LightArrays::Kind::dome, Rgb::Constant(radiance));
            scene.set_camera({0, 3, 4}, {distance, 0, 0}, Vec3::UnitZ(), 2e-4);
            ReferenceSettings settings = small_settings(4, 34, strategies);
            settings.joinable_only = JoinableLight{Vec3::Zero(), 1.0};
            auto renderer = scene.renderer(settings);
            renderer.render(0, 1 << 14);
            const BlockMean mean = image_mean(renderer.develop(), "G");
            const double a = std::asin(std::min(1.0, 1.0 / distance));
            const double expected = albedo / pi * radiance * (2 * a - std::sin(2 * a));
            const double error =
                std::sqrt(mean.variance) + 1e-6 * expected;  // the full dome has no noise
            suite.push_back({name, normal_p_value((mean.mean - expected) / error)});
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

}  // namespace
}  // namespace rtrays::reference
