// SPDX-License-Identifier: MIT
#include "renderer/scene/stores/light_store.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "renderer/base/angles.h"
#include "renderer/base/error.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/material.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/stores/mesh_store.h"
#include "renderer/scene/stores/pose.h"
#include "renderer/scene/stores/shape_store.h"

namespace rtrays {

namespace {

using Kind = LightArrays::Kind;

const LightCore *light_of(const Node &node) {
    return static_cast<const LightCore *>(node.core(CoreRole::light));
}

/// Returns the emissive material of the geometry at the node, or nullptr.
const MaterialCore *emission_of(const Node &node, const AttributeSet &attributes) {
    const MaterialCore *material = attributes.get<MaterialAttribute>().material;
    const bool emits =
        node.core(CoreRole::geometry) != nullptr && material != nullptr && material->emits();
    return emits ? material : nullptr;
}

}  // namespace

bool LightStore::holds(const Core &core) const {
    return core.role() == CoreRole::light || core.role() == CoreRole::geometry;
}

bool LightStore::concerns(const Node &node) const {
    return node.core(CoreRole::light) != nullptr || node.core(CoreRole::geometry) != nullptr;
}

bool LightStore::wants_record(const Node &node, const AttributeSet &attributes) const {
    return attributes.get<VisibilityAttribute>().visible &&
           (light_of(node) != nullptr || emission_of(node, attributes) != nullptr);
}

uint32_t LightStore::area_light_slot(const Node &node, const AttributeSet &attributes) const {
    const LightCore *light = light_of(node);
    const bool is_area = light != nullptr ? light->kind() == Kind::diffuse_area
                                          : emission_of(node, attributes) != nullptr;
    return is_area ? slot(node) : no_index;
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

void LightStore::write(uint32_t slot, const Node &node, const AttributeSet &attributes) {
    const LightCore *light = light_of(node);
    const MaterialCore *emission = emission_of(node, attributes);
    if (light != nullptr && emission != nullptr) {
        throw input_error(fmt::format(
            "light '{}': its geometry already emits through material '{}'; remove one of them, or "
            "give the light a node of its own",
            node.name(), emission->name()));
    }
    const MaterialCore *material = attributes.get<MaterialAttribute>().material;
    if ((light == nullptr || light->kind() == Kind::diffuse_area) && material != nullptr &&
        !material->is_opaque()) {
        throw input_error(fmt::format(
            "light '{}': its surface has the opacity of material '{}', but an area light must be "
            "opaque; remove the opacity or the light",
            node.name(), material->name()));
    }
    const Eigen::Matrix4d &world = attributes.get<TransformAttribute>().world_from_object;
    arrays.kind[slot] = light != nullptr ? light->kind() : Kind::diffuse_area;
    arrays.radiance[slot] =
        (light != nullptr ? light->radiance() : emission->emission()).cast<float>();
    arrays.image[slot] = light != nullptr ? light->image() : nullptr;
    arrays.mesh[slot] = arrays.shape[slot] = no_index;
    arrays.area[slot] = arrays.inner_angle[slot] = arrays.outer_angle[slot] = 0;
    Eigen::Matrix4d &pose = arrays.world_from_light[slot] = Eigen::Matrix4d::Identity();
    switch (arrays.kind[slot]) {
        case Kind::diffuse_area:
            write_area(slot, node);
            break;
        case Kind::point:
            pose.topRightCorner<3, 1>() = world.topRightCorner<3, 1>() - origin;
            break;
        case Kind::spot:
            pose = frame_along_z(world);
            pose.topRightCorner<3, 1>() -= origin;
            arrays.inner_angle[slot] = light->parameters().number("inner_degrees") * pi / 180;
            arrays.outer_angle[slot] = light->parameters().number("outer_degrees") * pi / 180;
            break;
        case Kind::directional:
            pose = frame_along_z(world);
            pose.topRightCorner<3, 1>().setZero();
            break;
        case Kind::dome:
            break;
        case Kind::environment:
            pose.topLeftCorner<3, 3>() =
                pose_of(world, fmt::format("light '{}'", node.name())).rigid.topLeftCorner<3, 3>();
            break;
    }
    if (!pose.cast<float>().allFinite()) {
        throw input_error(
            fmt::format("light '{}' is beyond the range of float in world space", node.name()));
    }
}

void LightStore::write_area(uint32_t slot, const Node &node) {
    arrays.mesh[slot] = meshes_.slot(node);
    arrays.shape[slot] = shapes_.slot(node);
    if (arrays.mesh[slot] == no_index && arrays.shape[slot] == no_index) {
        throw input_error(
            fmt::format("light '{}': an area light needs geometry at the same node", node.name()));
    }
    const bool is_mesh = arrays.mesh[slot] != no_index;
    arrays.area[slot] =
        is_mesh ? mesh_area(arrays.mesh[slot]) : shape_area(arrays.shape[slot], node.name());
    if (!(arrays.area[slot] > 0)) {
        throw input_error(
            fmt::format("light '{}': its {} has no area", node.name(), is_mesh ? "mesh" : "shape"));
    }
}

double LightStore::mesh_area(uint32_t mesh) const {
    const MeshArrays &meshes = meshes_.arrays;
    double area = 0;
    for (uint32_t i = 0; i < meshes.triangle_count[mesh]; ++i) {
        const Triangle &t = meshes.triangle[meshes.first_triangle[mesh] + i];
        const Eigen::Vector3d a = meshes.position[t[0]].cast<double>();
        const Eigen::Vector3d b = meshes.position[t[1]].cast<double>();
        const Eigen::Vector3d c = meshes.position[t[2]].cast<double>();
        area += 0.5 * (b - a).cross(c - a).norm();
    }
    return area;
}

double LightStore::shape_area(uint32_t shape, const std::string &name) const {
    const Eigen::Matrix4d &world = shapes_.arrays.world_from_object[shape];
    switch (shapes_.arrays.kind[shape]) {
        case ShapeArrays::Kind::disc:
            return pi * world.col(0).head<3>().cross(world.col(1).head<3>()).norm();
        case ShapeArrays::Kind::sphere:
            if (const double radius = similarity_scale(world); radius > 0) {
                return 4 * pi * radius * radius;
            }
            throw input_error(
                fmt::format("light '{}': an emitting sphere must not be stretched by its transform "
                            "or radii; use a mesh",
                            name));
        default:
            throw input_error(
                fmt::format("light '{}': among shapes only spheres and discs can emit; use one of "
                            "these or a mesh",
                            name));
    }
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
