// SPDX-License-Identifier: MIT
#include "reference/camera.h"

#include <gtest/gtest.h>

#include "reference/tests/test_scenes.h"
#include "renderer/base/error.h"

namespace rtrays::reference {
namespace {

using FovAxis = CameraArrays::FovAxis;

constexpr double fov = 0.8;

/// A camera at the origin with camera space equal to world space.
Camera camera_at_origin(FovAxis axis, int width, int height) {
    return Camera({{"camera"}, {Eigen::Matrix4d::Identity()}, {fov}, {axis}, {0}, {1}}, 0, width, height);
}

/// tan of the half angles towards the middle of the film's right and top edge.
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
        const Eigen::Vector2d extents = half_extents(camera_at_origin(axis, width, height), width, height);
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
    scene.set_camera({1, 2, 3}, {1, 2, 10}, Vec3::UnitY(), fov);  // looking along +z, so right is -x
    const Camera camera(scene.cameras, 0, 10, 10);
    const Ray centre = camera.ray(5, 5);
    EXPECT_EQ(centre.origin, Vec3(1, 2, 3));
    EXPECT_NEAR((centre.direction - Vec3(0, 0, 1)).norm(), 0.0, 1e-15);
    EXPECT_LT(camera.ray(10, 5).direction.x(), 0.0);
    EXPECT_GT(camera.ray(5, 0).direction.y(), 0.0);
}

TEST(Camera, refuses_impossible_angles_and_indices) {
    const CameraArrays flat{{"camera"}, {Eigen::Matrix4d::Identity()}, {pi}, {FovAxis::x}, {0}, {1}};
    EXPECT_THROW(Camera(flat, 0, 4, 4), Error);
    EXPECT_THROW(Camera(flat, 1, 4, 4), Error);
}

}  // namespace
}  // namespace rtrays::reference
