// SPDX-License-Identifier: MIT
// Tests orthographic cameras with the device code compiled for the host.
#define FEATURE_orthographic 1
#include "testing/other_features.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "renderer/compile/compile_scene.h"
#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/testing/shapes_double.h"

namespace rtrays {
namespace {

using Axis = CameraArrays::FovAxis;
using test::to_double;
using test::to_float3;

CameraArrays one_camera(Axis axis, double size) {
    CameraArrays cameras;
    cameras.name = {"camera"};
    cameras.world_from_camera = {Eigen::Matrix4d::Identity()};
    cameras.fov = {0};
    cameras.fov_axis = {axis};
    cameras.view_size = {size};
    cameras.aperture_radius = {0};
    cameras.focus_distance = {1};
    return cameras;
}

TEST(OrthographicCamera, RaysBeginOnTheFilm) {
    // The film has 40 x 20 pixels.
    for (const auto &[axis, x, y] :
         {std::tuple(Axis::x, 3.0f, 1.5f), std::tuple(Axis::y, 6.0f, 3.0f),
          std::tuple(Axis::smaller, 6.0f, 3.0f), std::tuple(Axis::larger, 3.0f, 1.5f)}) {
        const CameraRecord camera = compile_camera(one_camera(axis, 6), 0, 40, 20);
        const CameraRay corner = camera_ray(camera, 0, 0, 0.5f, 0.5f);  // top left
        EXPECT_NEAR(corner.origin.x, -x, 1e-6f);
        EXPECT_NEAR(corner.origin.y, y, 1e-6f);
        EXPECT_EQ(corner.origin.z, 0.0f);
        EXPECT_EQ(corner.direction.z, -1.0f);
        EXPECT_NEAR(camera.pixel_area, x / 20 * y / 10, 1e-6f);
        EXPECT_EQ(camera_pdf_w(camera, corner.direction), 1 / camera.pixel_area);
    }
}

TEST(OrthographicCamera, ConnectionsAreTheInverseOfRays) {
    CameraArrays cameras = one_camera(Axis::x, 6);
    cameras.world_from_camera[0].topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    cameras.world_from_camera[0].topRightCorner<3, 1>() = Eigen::Vector3d(4, -5, 6);
    const CameraRecord camera = compile_camera(cameras, 0, 40, 20);
    for (uint32_t i = 0; i < 10'000; ++i) {
        const uint4 w = random_words(7, STREAM_CAMERA, i, 0, 1);
        const float x = 40 * uniform_float(w.x), y = 20 * uniform_float(w.y);
        const CameraRay ray = camera_ray(camera, x, y, 0.5f, 0.5f);
        const float distance = 0.1f + 20 * uniform_float(w.z);
        const float3 point = ray.origin + ray.direction * distance;
        const CameraConnection met = camera_connection(camera, point, 0.5f, 0.5f);
        if (x > 1e-3f && y > 1e-3f && x < 39.999f && y < 19.999f) {
            ASSERT_NEAR(met.raster.x, x, 1e-3f);
            ASSERT_NEAR(met.raster.y, y, 1e-3f);
            ASSERT_NEAR(length(met.lens_point - ray.origin), 0.0f, 1e-4f);
            ASSERT_NEAR(met.pdf_w / (distance * distance) * camera.pixel_area, 1.0f, 1e-3f);
        }
        EXPECT_EQ(camera_connection(camera, ray.origin - ray.direction, 0.5f, 0.5f).pdf_w, 0.0f);
        const float3 outside = camera_ray(camera, x + 41, y, 0.5f, 0.5f).origin + ray.direction;
        EXPECT_EQ(camera_connection(camera, outside, 0.5f, 0.5f).pdf_w, 0.0f);
    }
}

// The film of a camera that is far from the scene moves along its rays.
TEST(OrthographicCamera, BeginsNearTheSceneIfItIsFarAway) {
    CameraArrays cameras = one_camera(Axis::x, 2);
    cameras.world_from_camera[0](2, 3) = 1e7;
    SceneExtent extent;
    extent.radius = 3;
    CameraRecord camera = compile_camera(cameras, 0, 10, 10);
    set_camera_start(cameras, 0, extent, camera);
    EXPECT_GE(camera.position[2], 3.0f);
    EXPECT_LT(camera.position[2], 6.0f);
    EXPECT_EQ(camera.start_distance, 0.0f);
    cameras.world_from_camera[0](2, 3) = 100;
    camera = compile_camera(cameras, 0, 10, 10);
    set_camera_start(cameras, 0, extent, camera);
    EXPECT_EQ(camera.position[2], 100.0f);
}

}  // namespace
}  // namespace rtrays
