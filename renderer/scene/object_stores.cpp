// SPDX-License-Identifier: MIT
#include "renderer/scene/object_stores.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "renderer/base/error.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/transform.h"

namespace rtrays {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// The rigid part of a pose; throws unless the rest of it is a uniform, positive scale, which a pinhole
/// camera cannot tell from none.
Eigen::Matrix4d rigid(const Eigen::Matrix4d &pose, const std::string &name) {
    constexpr double tolerance = 1e-6;
    const Eigen::Matrix3d axes = pose.topLeftCorner<3, 3>();
    const double scale = axes.col(0).stableNorm();
    const Eigen::Matrix3d unit = axes / scale;
    if (!((unit.transpose() * unit - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance)) {
        throw input_error(fmt::format("camera '{}': its transform shears or scales axes differently", name));
    }
    if (unit.determinant() < 0) {
        throw input_error(fmt::format("camera '{}': its transform mirrors", name));
    }
    Eigen::Matrix4d result = pose;
    result.topLeftCorner<3, 3>() = Eigen::Quaterniond(unit).normalized().toRotationMatrix();
    return result;
}

}  // namespace

void CameraStore::append(const Node &node) {
    arrays.name.push_back(node.name());
    arrays.world_from_camera.emplace_back();
    arrays.fov.emplace_back();
    arrays.fov_axis.emplace_back();
    arrays.aperture_radius.emplace_back();
    arrays.focus_distance.push_back(1);
}

void CameraStore::write(uint32_t slot, const Node &node, const AttributeSet &attributes) {
    const auto &camera = static_cast<const PinholeCamera &>(*node.core(role()));
    Eigen::Matrix4d pose = rigid(attributes.get<TransformAttribute>().world_from_object, node.name());
    pose.topRightCorner<3, 1>() -= origin;
    arrays.world_from_camera[slot] = pose;
    arrays.fov[slot] = camera.fov_degrees() * degree;
    arrays.fov_axis[slot] = camera.fov_axis();
}

void CameraStore::keep(const std::vector<uint32_t> &slots) {
    keep_elements(arrays.name, slots);
    keep_elements(arrays.world_from_camera, slots);
    keep_elements(arrays.fov, slots);
    keep_elements(arrays.fov_axis, slots);
    keep_elements(arrays.aperture_radius, slots);
    keep_elements(arrays.focus_distance, slots);
}

const void *MaterialStore::identity(const Node &node) const {
    return node.core(role());
}

uint32_t MaterialStore::slot_of_material(const MaterialCore *material) const {
    return slot_of(static_cast<const Core *>(material));
}

bool MaterialStore::is_current(uint32_t slot, const Node &node) const {
    return version_[slot] == node.core(role())->version();
}

void MaterialStore::append(const Node &node) {
    arrays.name.push_back(node.core(role())->name());
    arrays.first_component.push_back(static_cast<uint32_t>(arrays.component.size()));
    arrays.component_count.push_back(1);
    arrays.component.emplace_back();
    arrays.two_sided.push_back(1);
    version_.push_back(0);
}

void MaterialStore::write(uint32_t slot, const Node &node, const AttributeSet &) {
    const auto &material = static_cast<const LambertMaterial &>(*node.core(role()));
    BxdfComponent &component = arrays.component[arrays.first_component[slot]];
    component.kind = BxdfComponent::Kind::lambert;
    component.weight = material.reflectance().cast<float>();
    version_[slot] = material.version();
}

void MaterialStore::keep(const std::vector<uint32_t> &slots) {
    keep_elements(arrays.name, slots);
    keep_elements(arrays.component, slots);  // one each
    keep_elements(arrays.component_count, slots);
    arrays.first_component.resize(slots.size());
    std::iota(arrays.first_component.begin(), arrays.first_component.end(), 0u);
    keep_elements(arrays.two_sided, slots);
    keep_elements(version_, slots);
}

bool MeshStore::fits(uint32_t slot, const Node &node) const {
    const auto &mesh = static_cast<const MeshCore &>(*node.core(role()));
    return arrays.vertex_count[slot] == mesh.vertices().size() &&
           arrays.triangle_count[slot] == mesh.triangles().size();
}

void MeshStore::append(const Node &node) {
    const auto &mesh = static_cast<const MeshCore &>(*node.core(role()));
    const size_t first_vertex = arrays.position.size();
    const size_t first_triangle = arrays.triangle.size();
    if (first_vertex + mesh.vertices().size() >= no_index ||
        first_triangle + mesh.triangles().size() >= no_index) {
        throw input_error(
            fmt::format("mesh '{}': the scene has more than 2^32 vertices or triangles", node.name()));
    }
    arrays.name.push_back(node.name());
    arrays.first_triangle.push_back(static_cast<uint32_t>(first_triangle));
    arrays.triangle_count.push_back(static_cast<uint32_t>(mesh.triangles().size()));
    arrays.first_vertex.push_back(static_cast<uint32_t>(first_vertex));
    arrays.vertex_count.push_back(static_cast<uint32_t>(mesh.vertices().size()));
    arrays.material.push_back(no_index);
    arrays.light.push_back(no_index);
    arrays.has_normals.push_back(0);
    arrays.has_uv.push_back(0);
    arrays.position.resize(first_vertex + mesh.vertices().size());
    arrays.triangle.resize(first_triangle + mesh.triangles().size());
    arrays.triangle_mesh.resize(arrays.triangle.size(), static_cast<uint32_t>(arrays.name.size() - 1));
}

void MeshStore::write(uint32_t slot, const Node &node, const AttributeSet &attributes) {
    const auto &mesh = static_cast<const MeshCore &>(*node.core(role()));
    arrays.material[slot] = materials_.slot_of_material(attributes.get<MaterialAttribute>().material);
    if (arrays.material[slot] == no_index) {
        throw input_error(
            fmt::format("mesh '{}' has no material: give one to its node or to a node above", node.name()));
    }
    arrays.light[slot] = lights_.slot(node);

    const Eigen::Matrix4d &world_from_object = attributes.get<TransformAttribute>().world_from_object;
    const Eigen::Matrix3d linear = world_from_object.topLeftCorner<3, 3>();
    const Eigen::Vector3d offset = world_from_object.topRightCorner<3, 1>() - origin;
    const uint32_t first_vertex = arrays.first_vertex[slot];
    for (size_t i = 0; i < mesh.vertices().size(); ++i) {
        const Eigen::Vector3f baked = (linear * mesh.vertices()[i] + offset).cast<float>();
        if (!baked.allFinite()) {
            const Eigen::Vector3d &v = mesh.vertices()[i];
            throw input_error(
                fmt::format("mesh '{}': vertex {}, [{}, {}, {}], is beyond the range of float in world space",
                            node.name(), i, v[0], v[1], v[2]));
        }
        arrays.position[first_vertex + i] = baked;
    }
    const bool mirrors = linear.determinant() < 0;
    for (size_t i = 0; i < mesh.triangles().size(); ++i) {
        const Triangle &t = mesh.triangles()[i];
        arrays.triangle[arrays.first_triangle[slot] + i] = {
            first_vertex + t[0], first_vertex + t[mirrors ? 2 : 1], first_vertex + t[mirrors ? 1 : 2]};
    }
}

void MeshStore::keep(const std::vector<uint32_t> &slots) {
    uint32_t vertices = 0;
    uint32_t triangles = 0;
    for (uint32_t mesh = 0; mesh < slots.size(); ++mesh) {
        const uint32_t old = slots[mesh];
        const uint32_t moved_by = arrays.first_vertex[old] - vertices;
        for (uint32_t i = 0; i < arrays.vertex_count[old]; ++i) {
            arrays.position[vertices + i] = arrays.position[arrays.first_vertex[old] + i];
        }
        for (uint32_t i = 0; i < arrays.triangle_count[old]; ++i) {
            const Triangle &t = arrays.triangle[arrays.first_triangle[old] + i];
            arrays.triangle[triangles + i] = {t[0] - moved_by, t[1] - moved_by, t[2] - moved_by};
            arrays.triangle_mesh[triangles + i] = mesh;
        }
        arrays.first_vertex[old] = vertices;
        arrays.first_triangle[old] = triangles;
        vertices += arrays.vertex_count[old];
        triangles += arrays.triangle_count[old];
    }
    arrays.position.resize(vertices);
    arrays.triangle.resize(triangles);
    arrays.triangle_mesh.resize(triangles);
    keep_elements(arrays.name, slots);
    keep_elements(arrays.first_triangle, slots);
    keep_elements(arrays.triangle_count, slots);
    keep_elements(arrays.first_vertex, slots);
    keep_elements(arrays.vertex_count, slots);
    keep_elements(arrays.material, slots);
    keep_elements(arrays.light, slots);
    keep_elements(arrays.has_normals, slots);
    keep_elements(arrays.has_uv, slots);
}

void LightStore::append(const Node &node) {
    arrays.name.push_back(node.name());
    arrays.kind.emplace_back();
    arrays.radiance.emplace_back();
    arrays.mesh.push_back(no_index);
    arrays.shape.push_back(no_index);
    arrays.area.push_back(0);
    arrays.world_from_light.push_back(Eigen::Matrix4d::Identity());
    arrays.inner_angle.push_back(0);
    arrays.outer_angle.push_back(0);
    arrays.image.emplace_back();
}

void LightStore::write(uint32_t slot, const Node &node, const AttributeSet &) {
    const auto &light = static_cast<const DiffuseAreaLight &>(*node.core(role()));
    const uint32_t mesh = meshes_.slot(node);
    if (mesh == no_index) {
        throw input_error(
            fmt::format("light '{}': an area light needs geometry at the same node", node.name()));
    }
    const MeshArrays &meshes = meshes_.arrays;
    double area = 0;
    for (uint32_t i = 0; i < meshes.triangle_count[mesh]; ++i) {
        const Triangle &t = meshes.triangle[meshes.first_triangle[mesh] + i];
        const Eigen::Vector3d a = meshes.position[t[0]].cast<double>();
        const Eigen::Vector3d b = meshes.position[t[1]].cast<double>();
        const Eigen::Vector3d c = meshes.position[t[2]].cast<double>();
        area += 0.5 * (b - a).cross(c - a).norm();
    }
    if (!(area > 0)) {
        throw input_error(fmt::format("light '{}': its mesh has no area", node.name()));
    }
    arrays.kind[slot] = LightArrays::Kind::diffuse_area;
    arrays.radiance[slot] = light.radiance().cast<float>();
    arrays.mesh[slot] = mesh;
    arrays.area[slot] = area;
}

void LightStore::keep(const std::vector<uint32_t> &slots) {
    keep_elements(arrays.name, slots);
    keep_elements(arrays.kind, slots);
    keep_elements(arrays.radiance, slots);
    keep_elements(arrays.mesh, slots);
    keep_elements(arrays.shape, slots);
    keep_elements(arrays.area, slots);
    keep_elements(arrays.world_from_light, slots);
    keep_elements(arrays.inner_angle, slots);
    keep_elements(arrays.outer_angle, slots);
    keep_elements(arrays.image, slots);
}

}  // namespace rtrays
