// SPDX-License-Identifier: MIT
// Emitting spheres and discs: closed forms of their irradiance, and the densities of their samples.
#include <gtest/gtest.h>

#include "reference/light.h"
#include "reference/tests/sphere_grid.h"
#include "reference/tests/statistics.h"
#include "reference/tests/test_materials.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"
#include "renderer/base/statistics.h"

namespace rtrays::reference {
namespace {

using Kind = ShapeArrays::Kind;

constexpr double albedo = 0.5;
constexpr double radiance = 5.0;

TestScene floor_at(const Vec3 &point) {
    TestScene scene;
    scene.add_quad({Vec3(-10, 0, -10), Vec3(-10, 0, 10), Vec3(10, 0, 10), Vec3(10, 0, -10)},
                   scene.add_material(Rgb::Constant(albedo)));
    scene.set_camera({6.0, 1.5, 0.3}, point, Vec3::UnitY(), 2e-4);
    return scene;
}

void compare(const std::string &name, const TestScene &scene, double irradiance,
             std::vector<Comparison> &suite) {
    for (const auto &[strategy, strategies] : strategies_names) {
        ReferenceSettings settings = small_settings(4, 131, strategies);
        settings.max_depth = 1;
        auto renderer = scene.renderer(settings);
        renderer.render(0, 1 << 14);
        const BlockMean mean = image_mean(renderer.develop(), "G");
        const double expected = irradiance * albedo / pi;
        suite.push_back({name + " " + strategy,
                         normal_p_value((mean.mean - expected) / std::sqrt(mean.variance))});
        if (strategies == Strategies::explicit_only) {
            EXPECT_NEAR(mean.mean / expected, 1.0, 0.01) << name;
        }
    }
}

/// Returns a scaled transform to `position` in which +z faces down.
Eigen::Matrix4d ceiling(const Vec3 &position, double scale) {
    Eigen::Matrix4d transform = placed(position, scale);
    transform.topLeftCorner<3, 3>() *=
        Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()).toRotationMatrix();
    return transform;
}

TEST(RoundLights, irradiance_is_that_of_the_closed_forms) {
    std::vector<Comparison> suite;
    for (const double x : {0.0, 1.0, 3.0}) {
        // A sphere fully above the horizon: pi L (r / d)^2 cos.
        const Vec3 point(x, 0, 0), centre(0, 1.5, 0);
        TestScene sphere = floor_at(point);
        sphere.add_shape(Kind::sphere, placed(centre, 0.5), 0, Rgb::Constant(radiance));
        const double distance = (centre - point).norm();
        compare("sphere", sphere, pi * radiance * 0.25 * 1.5 / (distance * distance * distance),
                suite);
        // A parallel disc seen off its axis (Howell, A Catalog of Radiation Heat Transfer
        // Configuration Factors, B-13).
        TestScene disc = floor_at(point);
        disc.add_shape(Kind::disc, ceiling(centre, 0.8), 0, Rgb::Constant(radiance));
        const double h = 1.5 * 1.5 + x * x, r = 0.8 * 0.8;
        const double z = 1.5 * 1.5 + x * x + r;
        const double factor = 0.5 * (1.0 - (h - r) / std::sqrt(z * z - 4.0 * r * x * x));
        compare("disc", disc, pi * radiance * factor, suite);
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(RoundLights, extreme_spheres_keep_their_closed_form) {
    // One sphere has a radius of 1e-6 of its distance; the others are so near that they almost fill
    // the upper half space. The irradiance is L pi (r / d)^2, estimated as the mean of L cos /
    // pdf_w.
    constexpr int samples = 200000;
    std::vector<Comparison> suite;
    for (const auto &[radius, height] :
         {std::pair(1.5e-6, 1.5), std::pair(1.0, 1.0 + 1e-6), std::pair(1e6, 1.001e6)}) {
        TestScene scene;
        scene.add_shape(Kind::sphere, placed({0, height, 0}, radius),
                        scene.add_material(Rgb::Zero()), Rgb::Ones());
        const Geometry geometry(scene.meshes, scene.shapes);
        const LightSet lights(geometry, scene.lights);
        Rng rng(132, 0, 0);
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < samples; ++i) {
            const auto light = lights.sample(geometry, Vec3::Zero(), rng);
            ASSERT_TRUE(light);
            ASSERT_FALSE(geometry.occluded(Vec3::Zero(), light->target)) << i;
            const double value = light->wi.y() / light->pdf_w;
            sum += value;
            squares += square(value);
        }
        const double mean = sum / samples, expected = pi * square(radius / height);
        const double deviation =
            std::sqrt(std::max(squares / samples - square(mean), 0.0) / samples);
        // The variance of small cones is only rounding error.
        suite.push_back(
            {std::to_string(radius),
             normal_p_value((mean - expected) / std::hypot(deviation, 1e-9 * expected))});
        EXPECT_NEAR(mean / expected, 1.0, 0.01);
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

/// Returns a light above the origin that fills a part of the directions: a mirrored sphere or an
/// ellipse.
TestScene round_light(Kind kind) {
    TestScene scene;
    Eigen::Matrix4d transform = ceiling({0.4, 1.2, 0.3}, 0.9);
    transform.col(0) *= kind == Kind::disc ? -0.6 : -1.0;
    scene.add_shape(kind, transform, scene.add_material(Rgb::Zero()), Rgb::Ones());
    return scene;
}

/// Tests samples of that light against its density. The density is multiplied by 1 + planted on one
/// side of the middle of the light and by 1 - planted on the other.
SamplerCheck check_round_light(const Geometry &geometry, const LightSet &lights, int samples,
                               double planted, Rng &rng) {
    const DirectionSampler sample = [&](Rng &r) -> std::optional<Vec3> {
        const auto light = lights.sample(geometry, Vec3::Zero(), r);
        return light ? std::optional<Vec3>(light->wi) : std::nullopt;
    };
    const DirectionDensity density = [&](const Vec3 &wi) {
        SurfacePoint hit;
        return geometry.intersect({Vec3::Zero(), wi}, Coherence::incoherent, hit)
                   ? lights.pdf_w(geometry, 0, Vec3::Zero(), hit) *
                         (1.2 * wi.x() > 0.4 * wi.y() ? 1.0 + planted : 1.0 - planted)
                   : 0.0;
    };
    return check_sampler(sample, density, samples, rng);
}

TEST(RoundLights, sampled_directions_have_their_density) {
    std::vector<Comparison> suite;
    for (const Kind kind : {Kind::sphere, Kind::disc}) {
        const TestScene scene = round_light(kind);
        const Geometry geometry(scene.meshes, scene.shapes);
        const LightSet lights(geometry, scene.lights);
        Rng rng(133, 0, 0);
        const SamplerCheck check = check_round_light(geometry, lights, 200000, 0.0, rng);
        EXPECT_NEAR(check.total, 1.0, 2e-4);  // the rim runs through the cells
        suite.push_back({std::to_string(static_cast<int>(kind)), check.p_value});
        for (int i = 0; i < 10000; ++i) {
            const auto light = lights.sample(geometry, Vec3::Zero(), rng);
            ASSERT_TRUE(light);
            ASSERT_FALSE(geometry.occluded(Vec3::Zero(), light->target));
            SurfacePoint hit;
            if (geometry.intersect({Vec3::Zero(), light->wi}, Coherence::incoherent, hit)) {
                ASSERT_NEAR(lights.pdf_w(geometry, 0, Vec3::Zero(), hit) / light->pdf_w, 1.0, 1e-7);
            }
        }
    }
    EXPECT_EQ(holm_rejected(suite), std::vector<std::string>{});
}

TEST(RoundLights, the_chi_square_test_sees_two_percent) {
    for (const Kind kind : {Kind::sphere, Kind::disc}) {
        const TestScene scene = round_light(kind);
        const Geometry geometry(scene.meshes, scene.shapes);
        Rng rng(135, 0, 0);
        const SamplerCheck check =
            check_round_light(geometry, LightSet(geometry, scene.lights), 1000000, 0.02, rng);
        EXPECT_LT(check.p_value, 0.01 * family_alpha) << static_cast<int>(kind);
    }
}

TEST(RoundLights, the_inside_of_a_sphere_and_the_back_of_a_disc_are_dark) {
    for (const Kind kind : {Kind::sphere, Kind::disc}) {
        TestScene scene;
        scene.add_shape(kind, ceiling({0, 1, 0}, 3.0), scene.add_material(Rgb::Constant(0.5f)),
                        Rgb::Ones());
        scene.set_camera({0, kind == Kind::disc ? 2.0 : 0.5, 0}, {0, 1, 0}, Vec3::UnitX(), 0.5);
        auto renderer = scene.renderer(small_settings(4, 134));
        renderer.render(0, 64);
        EXPECT_EQ(image_mean(renderer.develop(), "R").mean, 0.0);
    }
}

TEST(RoundLights, spheres_emit_under_similarities_and_discs_under_all_maps) {
    const auto construct = [](Kind kind, double stretch) {
        TestScene scene;
        Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
        transform(0, 0) = stretch;
        scene.add_shape(kind, transform, scene.add_material(Rgb::Zero()), Rgb::Ones());
        const Geometry geometry(scene.meshes, scene.shapes);
        return LightSet(geometry, scene.lights);
    };
    EXPECT_THROW(construct(Kind::sphere, 1.5), Error);
    EXPECT_THROW(construct(Kind::cylinder, 1.0), Error);
    EXPECT_NO_THROW(construct(Kind::sphere, -1.0));
    EXPECT_NO_THROW(construct(Kind::disc, 1.5));
}

}  // namespace
}  // namespace rtrays::reference
