// SPDX-License-Identifier: MIT
// Compiles the sphere around a scene and the distances that follow from it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "renderer/compile/compile_scene.h"

namespace rtrays {

SceneExtent extent_of_shape(const ShapeRecord &record) {
    Eigen::Matrix<double, 3, 4> world;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            world(row, column) = static_cast<double>(record.world_from_object[row][column]);
        }
    }
    const bool flat = record.uv_kind == SHAPE_UV_DISC;
    const double stretch =
        flat ? world.leftCols<2>().operatorNorm() : world.leftCols<3>().operatorNorm();
    return {world.col(3), stretch * std::sqrt(static_cast<double>(record.bound2))};
}

namespace {

/// Returns the smallest sphere about the centre of the bounding box.
SceneExtent tight_extent(const SceneArrays &scene, const CompiledScene &compiled) {
    std::vector<SceneExtent> shapes;
    for (size_t i = 0; i < scene.shapes.kind.size(); ++i) {
        if (scene.shapes.kind[i] != ShapeArrays::Kind::plane) {
            shapes.push_back(extent_of_shape(compiled.shapes[i]));
        }
    }
    const bool encloses = shapes.size() == scene.shapes.kind.size();
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f &position : scene.meshes.position) {
        box.extend(position.cast<double>());
    }
    for (const SceneExtent &shape : shapes) {
        box.extend(shape.centre + Eigen::Vector3d::Constant(shape.radius));
        box.extend(shape.centre - Eigen::Vector3d::Constant(shape.radius));
    }
    if (box.isEmpty()) {
        // Light paths from infinity are traced towards the surroundings of the camera.
        return {Eigen::Vector3f(compiled.camera.position).cast<double>(), 1.0, false, encloses};
    }
    SceneExtent extent = {box.center(), 0, true, encloses};
    for (const Eigen::Vector3f &position : scene.meshes.position) {
        extent.radius = std::max(extent.radius, (position.cast<double>() - extent.centre).norm());
    }
    for (const SceneExtent &shape : shapes) {
        extent.radius =
            std::max(extent.radius, (shape.centre - extent.centre).norm() + shape.radius);
    }
    return extent;
}

}  // namespace

SceneExtent compile_extent(const SceneArrays &scene, const CompiledScene &compiled) {
    SceneExtent extent = tight_extent(scene, compiled);
    extent.radius =
        std::max(extent.radius * (1.0 + 0x1p-10) + extent.centre.norm() * 0x1p-20, 1e-15);
    return extent;
}

void compile_distances(CompiledScene &compiled) {
    // Beyond every point of the scene, except on planes, whose horizon is cut off at about a
    // million radii. Shadow rays to infinity have this length; hits measured in units of it keep
    // their relative precision.
    const SceneExtent &extent = compiled.extent;
    const double camera =
        (Eigen::Vector3f(compiled.camera.position).cast<double>() - extent.centre).norm();
    compiled.lighting.far_distance = static_cast<float>(0x1p20 * (extent.radius + camera));
    compiled.lighting.camera_start_distance = camera_start_distance(compiled.camera, extent);
    compiled.lighting.orthographic_camera = compiled.camera.orthographic;
}

}  // namespace rtrays
