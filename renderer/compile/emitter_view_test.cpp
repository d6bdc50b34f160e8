// SPDX-License-Identifier: MIT
// Tests which emitters a camera may see: cases by hand, and random ones by projected points.
#include "renderer/compile/emitter_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "renderer/scene/stores.h"

namespace rtrays {
namespace {

using Eigen::Vector3d;

/// A camera that looks along -z of its frame, with a full angle of view in x.
struct Pinhole {
    Eigen::Isometry3d world = Eigen::Isometry3d::Identity();
    double fov = 2 * std::atan(0.5);
    int width = 4, height = 2;

    CameraRecord record() const {
        CameraArrays cameras;
        cameras.name = {"camera"};
        cameras.world_from_camera = {world.matrix()};
        cameras.fov = {fov};
        cameras.fov_axis = {CameraArrays::FovAxis::x};
        cameras.view_size = {0};
        cameras.aperture_radius = {0};
        cameras.focus_distance = {1};
        return compile_camera(cameras, 0, width, height);
    }

    /// Returns whether the film shows a point.
    bool shows(const Vector3d &point) const {
        const Vector3d local = world.inverse() * point;
        const double half = std::tan(fov / 2) * -local.z();
        return local.z() < 0 && std::abs(local.x()) <= half &&
               std::abs(local.y()) <= half * height / width;
    }
};

void copy(const Vector3d &from, float (&to)[3]) {
    for (int i = 0; i < 3; ++i) {
        to[i] = static_cast<float>(from[i]);
    }
}

CompiledScene triangle(const Vector3d &a, const Vector3d &b, const Vector3d &c) {
    CompiledScene scene;
    scene.surface_triangles.resize(2);  // the first one does not emit
    copy(a, scene.surface_triangles[1].p0);
    copy(b, scene.surface_triangles[1].p1);
    copy(c, scene.surface_triangles[1].p2);
    scene.emitter_triangles.resize(1);
    scene.emitter_triangles[0].triangle = 1;
    return scene;
}

CompiledScene sphere(const Vector3d &centre, double radius, uint32_t light = 0) {
    CompiledScene scene;
    ShapeRecord shape{};
    for (int i = 0; i < 3; ++i) {
        shape.world_from_object[i][i] = static_cast<float>(radius);
        shape.world_from_object[i][3] = static_cast<float>(centre[i]);
    }
    shape.bound2 = 1;
    shape.light = light;
    scene.shapes.push_back(shape);
    return scene;
}

TEST(EmitterView, IsThePyramidOfTheFilm) {
    const CameraRecord camera = Pinhole().record();  // |x| <= -z / 2, |y| <= -z / 4
    EXPECT_FALSE(emitters_in_view(CompiledScene(), camera));
    const auto sees = [&](double x, double y, double z, double radius) {
        return emitters_in_view(sphere({x, y, z}, radius), camera);
    };
    EXPECT_TRUE(sees(0, 0, -2, 0.1));
    EXPECT_TRUE(sees(0.99, 0.49, -2, 1e-6));
    EXPECT_FALSE(sees(1.01, 0, -2, 1e-6));
    EXPECT_FALSE(sees(0, 0.51, -2, 1e-6));
    EXPECT_FALSE(sees(0, 0, 2, 0.1)) << "behind the camera";
    EXPECT_TRUE(sees(0, 0, 2, 2.1)) << "around the camera";
    // The side x = -z / 2 has the distance 1 / sqrt(1.25) from (2, 0, -2).
    EXPECT_TRUE(sees(2, 0, -2, 1 / std::sqrt(1.25) + 1e-4));
    EXPECT_FALSE(sees(2, 0, -2, 1 / std::sqrt(1.25) - 1e-3));
    EXPECT_FALSE(emitters_in_view(sphere({0, 0, -2}, 0.1, NO_EMITTER), camera));
    // All corners are outside, each beyond another side.
    EXPECT_TRUE(emitters_in_view(triangle({-9, -9, -2}, {9, -9, -2}, {0, 9, -2}), camera));
    EXPECT_FALSE(emitters_in_view(triangle({-9, 1, -2}, {9, 1, -2}, {0, 9, -2}), camera));
}

TEST(EmitterView, IsAssumedForLensesAndParallelRays) {
    CameraRecord lens = Pinhole().record();
    lens.aperture_radius = 0.1f;
    CameraRecord orthographic = Pinhole().record();
    orthographic.orthographic = 1;
    EXPECT_TRUE(emitters_in_view(sphere({0, 0, 9}, 1), lens));
    EXPECT_TRUE(emitters_in_view(sphere({0, 0, 9}, 1), orthographic));
}

/// Narrow and wide views, and coordinates that lose digits to a distance from the origin.
class RandomViews : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(RandomViews, NeverMissAPointOnTheFilm) {
    const auto [fov, distance] = GetParam();
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto direction = [&] {
        const double z = 2 * unit(generator) - 1, angle = 2 * M_PI * unit(generator);
        return Vector3d(std::sqrt(1 - z * z) * std::cos(angle),
                        std::sqrt(1 - z * z) * std::sin(angle), z);
    };
    int excluded = 0, shown = 0;
    for (int i = 0; i < 4000; ++i) {
        Pinhole pinhole;
        pinhole.fov = fov;
        pinhole.world = Eigen::Translation3d(distance * direction()) *
                        Eigen::AngleAxisd(2 * M_PI * unit(generator), direction());
        // A triangle near the edge of the view, as the renderer has it: in float.
        const Vector3d near =
            pinhole.world * Vector3d((2 * unit(generator) - 1) * 2 * std::tan(fov / 2),
                                     (2 * unit(generator) - 1) * std::tan(fov / 2), -1);
        const double size = fov * unit(generator);
        const auto corner = [&] {
            return Vector3d((near + size * direction()).cast<float>().cast<double>());
        };
        const Vector3d a = corner(), b = corner(), c = corner();
        const bool in_view = emitters_in_view(triangle(a, b, c), pinhole.record());
        excluded += in_view ? 0 : 1;
        for (int k = 0; k < 20; ++k) {
            const double u = unit(generator), v = unit(generator) * (1 - u);
            const bool is_shown = pinhole.shows(a + u * (b - a) + v * (c - a));
            shown += is_shown ? 1 : 0;
            ASSERT_TRUE(in_view || !is_shown) << "case " << i;
        }
    }
    EXPECT_GT(excluded, 400);
    EXPECT_GT(shown, 4000);
}

TEST_P(RandomViews, HaveAMarginForRoundedPositions) {
    const auto [fov, distance] = GetParam();
    for (int i = 0; i < 100; ++i) {
        Pinhole pinhole;
        pinhole.fov = fov;
        pinhole.world = Eigen::Translation3d(distance * Vector3d(0.7, -0.3, 0.64)) *
                        Eigen::AngleAxisd(0.1 * i, Vector3d(0.48, 0.6, 0.64));
        const Vector3d on_edge = pinhole.world * Vector3d(std::tan(fov / 2), 0, -1);
        EXPECT_TRUE(emitters_in_view(sphere(on_edge, 0), pinhole.record())) << "case " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(All, RandomViews,
                         testing::Combine(testing::Values(0.01, 1.0, 2.8),
                                          testing::Values(0.0, 100.0)));

}  // namespace
}  // namespace rtrays
