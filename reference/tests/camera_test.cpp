// SPDX-License-Identifier: MIT
#include "reference/camera.h"

#include <gtest/gtest.h>

#include "reference/tests/statistics.h"
#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"
#include "renderer/testing/chi_square.h"

namespace rtrays::reference {
namespace {

using FovAxis = CameraArrays::FovAxis;

constexpr double fov = 0.8;

/// Returns a camera at the origin whose camera space equals world space.
Camera camera_at_origin(FovAxis axis, int width, int height) {
    return Camera({{"camera"}, {Eigen::Matrix4d::Identity()}, {fov}, {axis}, {0}, {0}, {1}}, 0,
                  width, height);
}

/// Returns the tangents of the half angles towards the middle of the film's right and top edges.
Eigen::Vector2d half_extents(const Camera &camera, int width, int height) {
    const Vec3 right = camera.ray(width, 0.5 * height).direction;
    const Vec3 top = camera.ray(0.5 * width, 0.0).direction;
    return {right.x() / -right.z(), top.y() / -top.z()};
}

TEST(Camera, looks_along_minus_z_with_x_right_and_y_up) {
    const Camera camera = camera_at_origin(FovAxis::x, 6, 4);
    EXPECT_NEAR((camera.ray(3.0, 2.0).direction - Vec3(0, 0, -1)).norm(), 0.0, 1e-15);
    const double extent = std::tan(0.5 * fov);
    const Vec3 top_left = Vec3(-extent, extent * 4.0 / 6.0, -1.0).normalized();
    const Vec3 bottom_right = Vec3(extent, -extent * 4.0 / 6.0, -1.0).normalized();
    EXPECT_NEAR((camera.ray(0.0, 0.0).direction - top_left).norm(), 0.0, 1e-15);
    EXPECT_NEAR((camera.ray(6.0, 4.0).direction - bottom_right).norm(), 0.0, 1e-15);
}

TEST(Camera, measures_the_field_of_view_along_its_axis) {
    const double t = std::tan(0.5 * fov);
    const auto expect_extents = [](FovAxis axis, int width, int height, double x, double y) {
        const Eigen::Vector2d extents =
            half_extents(camera_at_origin(axis, width, height), width, height);
        EXPECT_NEAR(extents.x(), x, 1e-14);
        EXPECT_NEAR(extents.y(), y, 1e-14);
    };
    expect_extents(FovAxis::x, 300, 200, t, t / 1.5);
    expect_extents(FovAxis::y, 300, 200, t * 1.5, t);
    expect_extents(FovAxis::smaller, 300, 200, t * 1.5, t);
    expect_extents(FovAxis::larger, 300, 200, t, t / 1.5);
    expect_extents(FovAxis::smaller, 200, 300, t, t * 1.5);
    expect_extents(FovAxis::larger, 200, 300, t / 1.5, t);
}

TEST(Camera, turns_and_moves_with_its_matrix) {
    TestScene scene;
    // The camera looks along +z, so right is -x.
    scene.set_camera({1, 2, 3}, {1, 2, 10}, Vec3::UnitY(), fov);
    const Camera camera(scene.cameras, 0, 10, 10);
    const Ray centre = camera.ray(5, 5);
    EXPECT_EQ(centre.origin, Vec3(1, 2, 3));
    EXPECT_NEAR((centre.direction - Vec3(0, 0, 1)).norm(), 0.0, 1e-15);
    EXPECT_LT(camera.ray(10, 5).direction.x(), 0.0);
    EXPECT_GT(camera.ray(5, 0).direction.y(), 0.0);
}

TEST(Camera, refuses_impossible_angles_and_indices) {
    const CameraArrays flat{{"camera"}, {Eigen::Matrix4d::Identity()}, {pi}, {FovAxis::x}, {0}, {0},
                            {1}};
    EXPECT_THROW(Camera(flat, 0, 4, 4), Error);
    EXPECT_THROW(Camera(flat, 1, 4, 4), Error);
}

TEST(Camera, a_lens_focuses_on_its_plane) {
    CameraArrays cameras{
        {"camera"}, {Eigen::Matrix4d::Identity()}, {fov}, {FovAxis::x}, {0.0}, {0.3}, {4.0}};
    cameras.world_from_camera[0].topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    cameras.world_from_camera[0].topRightCorner<3, 1>() = Vec3(5, -6, 7);
    const Camera camera(cameras, 0, 6, 4);
    const Eigen::Affine3d to_camera = Eigen::Affine3d(cameras.world_from_camera[0]).inverse();
    const Vec3 straight = to_camera.linear() * camera.ray(1.3, 0.4).direction;
    const Vec3 focus = straight * (4.0 / -straight.z());
    Rng rng(151, 0, 0);
    Vec3 mean = Vec3::Zero();
    double squares = 0.0;
    constexpr int samples = 100000;
    for (int i = 0; i < samples; ++i) {
        const Ray ray = camera.ray(1.3, 0.4, rng);
        const Vec3 origin = to_camera * ray.origin, direction = to_camera.linear() * ray.direction;
        ASSERT_NEAR(direction.norm(), 1.0, 1e-14);
        ASSERT_NEAR(origin.z(), 0.0, 1e-14);
        ASSERT_LE(origin.norm(), 0.3 + 1e-14);
        ASSERT_NEAR((origin + direction * (4.0 / -direction.z()) - focus).norm(), 0.0, 1e-13);
        mean += origin / samples;
        squares += origin.squaredNorm() / samples;
    }
    // A uniform disc has the mean 0 with a deviation of r / 2 per axis. Its mean square is r^2 / 2
    // with a deviation of r^2 / sqrt(12).
    EXPECT_LT(mean.norm(), 4.0 * 0.15 * std::sqrt(2.0 / samples));
    EXPECT_NEAR(squares, 0.045, 4.0 * 0.09 / std::sqrt(12.0 * samples));
}

TEST(Camera, points_of_the_lens_are_uniform_and_two_percent_are_seen) {
    const CameraArrays cameras{
        {"camera"}, {Eigen::Matrix4d::Identity()}, {fov}, {FovAxis::x}, {0.0}, {0.3}, {4.0}};
    const Camera camera(cameras, 0, 6, 4);
    Rng rng(154, 0, 0);
    constexpr int samples = 1000000, rings = 10, sectors = 16;
    std::vector<uint64_t> observed(rings * sectors, 0);
    for (int i = 0; i < samples; ++i) {
        const Vec3 on_lens = camera.ray(1.3, 0.4, rng).origin;
        const int ring = static_cast<int>(on_lens.squaredNorm() / square(0.3) * rings);
        const int sector =
            static_cast<int>((std::atan2(on_lens.y(), on_lens.x()) / (2.0 * pi) + 0.5) * sectors);
        ++observed[static_cast<size_t>(std::min(ring, rings - 1) * sectors +
                                       std::min(sector, sectors - 1))];
    }
    std::vector<double> uniform(observed.size(), samples / static_cast<double>(rings * sectors));
    EXPECT_GT(chi_square_p(observed, uniform), family_alpha);
    for (size_t i = 0; i < uniform.size(); ++i) {
        uniform[i] *= i < uniform.size() / 2 ? 1.01 : 0.99;  // 2 % between the halves of the lens
    }
    EXPECT_LT(chi_square_p(observed, uniform), 0.01 * family_alpha);
}

TEST(Camera, a_closed_lens_is_a_pinhole_and_broken_ones_are_refused) {
    CameraArrays cameras{
        {"camera"}, {Eigen::Matrix4d::Identity()}, {fov}, {FovAxis::x}, {0.0}, {0.0}, {0.0}};
    Rng rng(152, 0, 0), untouched(152, 0, 0);
    const Camera camera(cameras, 0, 6, 4);
    EXPECT_EQ(camera.ray(1.0, 2.0, rng).direction, camera.ray(1.0, 2.0).direction);
    EXPECT_EQ(rng.next_bits(), untouched.next_bits());
    cameras.aperture_radius[0] = 0.1;
    EXPECT_THROW(Camera(cameras, 0, 6, 4), Error);  // in focus at distance 0
    cameras.aperture_radius[0] = -0.1;
    cameras.focus_distance[0] = 1.0;
    EXPECT_THROW(Camera(cameras, 0, 6, 4), Error);
}

TEST(Camera, a_point_out_of_focus_spreads_over_its_circle_of_confusion) {
    // A small disc light is at twice the focus distance. The rays of a pixel meet in the plane of
    // focus. At the light they have spread again to a disc as large as the lens.
    TestScene scene;
    Eigen::Matrix4d facing = placed({0, 0, -8}, 0.05);  // +z faces the camera
    scene.add_shape(ShapeArrays::Kind::disc, facing, scene.add_material(Rgb::Zero()), Rgb::Ones());
    scene.set_camera(Vec3::Zero(), {0, 0, -1}, Vec3::UnitY(), 2.0 * std::atan(0.25));
    scene.cameras.aperture_radius[0] = 0.5;
    scene.cameras.focus_distance[0] = 4.0;
    auto renderer = scene.renderer(small_settings(16, 153));
    renderer.render(0, 4096);
    const BlockMean mean = image_mean(renderer.develop(), "R");
    // At distance 8 the chief rays cover 4 x 4, and the rays of each pixel spread over a disc of
    // radius 0.5. The spread moves light from one pixel to another but keeps the mean.
    EXPECT_NEAR(mean.mean, pi * square(0.05) / 16.0, 4.0 * std::sqrt(mean.variance));
    const Image image = renderer.develop();
    const auto lit = [&](int x, int y) {
        return image.channel("R")[static_cast<size_t>(16 * y + x)] > 0.0f;
    };
    EXPECT_TRUE(lit(8, 8) && lit(9, 8) && lit(6, 8));  // pixels are 0.25 wide there
    EXPECT_FALSE(lit(8, 11) || lit(3, 8));
}

TEST(Camera, orthographic_rays_are_parallel) {
    CameraArrays cameras;
    cameras.name = {"camera"};
    cameras.world_from_camera = {Eigen::Matrix4d::Identity()};
    cameras.fov = {0.0};
    cameras.fov_axis = {CameraArrays::FovAxis::y};
    cameras.view_size = {6.0};
    cameras.aperture_radius = {0.0};
    cameras.focus_distance = {1.0};
    const Camera camera(cameras, 0, 40, 20);
    const Ray corner = camera.ray(0.0, 0.0), middle = camera.ray(20.0, 10.0);
    EXPECT_LT((corner.origin - Vec3(-6.0, 3.0, 0.0)).norm(), 1e-12);
    EXPECT_LT(middle.origin.norm(), 1e-12);
    EXPECT_EQ(corner.direction, Vec3(0.0, 0.0, -1.0));
    EXPECT_EQ(middle.direction, corner.direction);
}

}  // namespace
}  // namespace rtrays::reference
