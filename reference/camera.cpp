// SPDX-License-Identifier: MIT
#include "reference/camera.h"

#include <fmt/format.h>

#include <cmath>

#include "renderer/base/error.h"

namespace rtrays::reference {

namespace {

bool fov_is_horizontal(CameraArrays::FovAxis axis, int width, int height) {
    switch (axis) {
        case CameraArrays::FovAxis::x:
            return true;
        case CameraArrays::FovAxis::y:
            return false;
        case CameraArrays::FovAxis::smaller:
            return width <= height;
        case CameraArrays::FovAxis::larger:
            return width >= height;
    }
    throw run_error("camera: unknown field-of-view axis");
}

}  // namespace

Camera::Camera(const CameraArrays &cameras, size_t index, int width, int height) {
    if (index >= cameras.fov.size()) {
        throw input_error(fmt::format("camera {}: index out of range; the scene has {} camera(s)",
                                      index, cameras.fov.size()));
    }
    if (width < 1 || height < 1) {
        throw input_error(
            fmt::format("the film must have at least one pixel, got {}x{}", width, height));
    }
    const double fov = cameras.fov[index];
    const bool is_parallel = cameras.is_orthographic(index);
    if (is_parallel && !std::isfinite(cameras.view_size[index])) {
        throw input_error(fmt::format("camera {}: its size must be finite", index));
    }
    if (!is_parallel && !(fov > 0.0 && fov < pi)) {
        throw input_error(
            fmt::format("camera {}: field of view {} rad is outside (0, pi)", index, fov));
    }
    // Pixels are square, so the extent along one axis determines their size on the plane z = -1.
    const double extent = is_parallel ? cameras.view_size[index] : 2.0 * std::tan(0.5 * fov);
    const double pixel =
        extent / (fov_is_horizontal(cameras.fov_axis[index], width, height) ? width : height);

    const Eigen::Matrix4d &world_from_camera = cameras.world_from_camera[index];
    const Eigen::Matrix3d rotation = world_from_camera.topLeftCorner<3, 3>();
    position_ = world_from_camera.topRightCorner<3, 1>();
    axis_ = is_parallel ? Vec3(-rotation.col(2)) : Vec3(0.0, 0.0, 0.0);
    corner_ = rotation * Vec3(-0.5 * pixel * width, 0.5 * pixel * height, is_parallel ? 0.0 : -1.0);
    step_x_ = rotation * Vec3(pixel, 0.0, 0.0);
    step_y_ = rotation * Vec3(0.0, -pixel, 0.0);

    const double aperture = cameras.aperture_radius[index];
    focus_distance_ = cameras.focus_distance[index];
    if (!(aperture >= 0.0 && std::isfinite(aperture)) ||
        (aperture > 0.0 && !(focus_distance_ > 0.0 && std::isfinite(focus_distance_)))) {
        throw input_error(
            fmt::format("camera {}: the aperture radius must not be negative and the focus "
                        "distance must be positive",
                        index));
    }
    lens_x_ = aperture * rotation.col(0);
    lens_y_ = aperture * rotation.col(1);
}

}  // namespace rtrays::reference
