// SPDX-License-Identifier: MIT
#include "renderer/scene/stores/mesh_store.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/stores/geometry_record.h"
#include "renderer/scene/stores/light_store.h"

namespace rtrays {

namespace {

const MeshCore &mesh_at(const Node &node) {
    return static_cast<const MeshCore &>(*node.core(CoreRole::geometry));
}

/// Returns the inverse transpose of a linear transform, up to a positive factor. The columns are
/// normalised before the inversion; their lengths then become factors of at most 1. Neither the
/// result nor the transformed normals can exceed the range of double.
Eigen::Matrix3d normal_transform(const Eigen::Matrix3d &linear) {
    Eigen::Vector3d lengths;
    for (int i = 0; i < 3; ++i) {
        lengths[i] = linear.col(i).stableNorm();  // positive: transforms are invertible
    }
    Eigen::Matrix3d unit;
    for (int i = 0; i < 3; ++i) {
        unit.col(i) = linear.col(i) / lengths[i];
    }
    Eigen::Matrix3d transform = unit.inverse().transpose();
    for (int i = 0; i < 3; ++i) {
        transform.col(i) *= lengths.minCoeff() / lengths[i];
    }
    return transform;
}

/// Assigns a value, and counts a change if it differs from the old one.
template <typename T>
void assign(T &to, const T &value, uint64_t &changes) {
    changes += to != value ? 1 : 0;
    to = value;
}

/// Sets a flag of a mesh and updates the number of meshes that have it.
void set_flag(uint8_t &flag, bool value, size_t &count, uint64_t &changes) {
    count = count - flag + (value ? 1 : 0);
    assign(flag, static_cast<uint8_t>(value ? 1 : 0), changes);
}

/// Writes one vector per vertex from `first` on: vector(i) for vertex i, or `missing` from the end
/// of the source on.
template <typename Iterator, typename Source, typename Vector>
void write_vectors(Iterator first, size_t count, const Source &source, const Vector &vector,
                   const std::decay_t<decltype(*std::declval<Iterator>())> &missing,
                   uint64_t &changes) {
    for (size_t i = 0; i < count; ++i, ++first) {
        assign(*first, i < source.size() ? vector(source[i]) : missing, changes);
    }
}

/// Moves a range of per-vertex values down, unless the array is empty.
template <typename T>
void move_range(std::vector<T> &values, uint32_t to, uint32_t from, uint32_t count) {
    if (!values.empty()) {
        std::copy(values.begin() + from, values.begin() + from + count, values.begin() + to);
    }
}

}  // namespace

bool MeshStore::holds(const Core &core) const {
    return dynamic_cast<const MeshCore *>(&core) != nullptr;
}

bool MeshStore::concerns(const Node &node) const {
    return node.core_of<MeshCore>(CoreRole::geometry) != nullptr;
}

bool MeshStore::wants_record(const Node &, const AttributeSet &attributes) const {
    return attributes.get<VisibilityAttribute>().visible;
}

bool MeshStore::fits(uint32_t slot, const Node &node) const {
    return arrays.vertex_count[slot] == mesh_at(node).vertices().size() &&
           arrays.triangle_count[slot] == mesh_at(node).triangles().size();
}

void MeshStore::append(const Node &node) {
    const MeshCore &mesh = mesh_at(node);
    const size_t first_vertex = arrays.position.size();
    const size_t first_triangle = arrays.triangle.size();
    if (first_vertex + mesh.vertices().size() >= no_index ||
        first_triangle + mesh.triangles().size() >= no_index) {
        throw input_error(fmt::format(
            "mesh '{}': the scene has more than 2^32 vertices or triangles", node.name()));
    }
    ++geometry_version_;
    ++surface_version_;
    arrays.name.push_back(node.name());
    arrays.first_triangle.push_back(static_cast<uint32_t>(first_triangle));
    arrays.triangle_count.push_back(static_cast<uint32_t>(mesh.triangles().size()));
    arrays.first_vertex.push_back(static_cast<uint32_t>(first_vertex));
    arrays.vertex_count.push_back(static_cast<uint32_t>(mesh.vertices().size()));
    arrays.material.push_back(no_index);
    arrays.light.push_back(no_index);
    arrays.has_normals.push_back(0);
    arrays.has_uv.push_back(0);
    arrays.has_colour.push_back(0);
    const size_t vertices = first_vertex + mesh.vertices().size();
    arrays.position.resize(vertices, Eigen::Vector3f::Zero());
    if (!arrays.normal.empty()) {
        arrays.normal.resize(vertices, Eigen::Vector3f::Zero());
    }
    if (!arrays.uv.empty()) {
        arrays.uv.resize(vertices, Eigen::Vector2f::Zero());
    }
    if (!arrays.colour.empty()) {
        arrays.colour.resize(vertices, Rgb::Ones());
    }
    arrays.triangle.resize(first_triangle + mesh.triangles().size());
    arrays.triangle_mesh.resize(arrays.triangle.size(),
                                static_cast<uint32_t>(arrays.name.size() - 1));
}

void MeshStore::write(uint32_t slot, const Node &node, const AttributeSet &attributes) {
    const MeshCore &mesh = mesh_at(node);
    assign(arrays.material[slot], material_slot(materials_, attributes, "mesh", node.name()),
           surface_version_);
    assign(arrays.light[slot], lights_.area_light_slot(node, attributes), surface_version_);

    const Eigen::Matrix4d &world_from_object =
        attributes.get<TransformAttribute>().world_from_object;
    const Eigen::Matrix3d linear = world_from_object.topLeftCorner<3, 3>();
    const Eigen::Vector3d offset = world_from_object.topRightCorner<3, 1>() - origin;
    const uint32_t first_vertex = arrays.first_vertex[slot];
    for (size_t i = 0; i < mesh.vertices().size(); ++i) {
        const Eigen::Vector3f baked = (linear * mesh.vertices()[i] + offset).cast<float>();
        if (!baked.allFinite()) {
            const Eigen::Vector3d &v = mesh.vertices()[i];
            throw input_error(fmt::format(
                "mesh '{}': vertex {}, [{}, {}, {}], is beyond the range of float in world space",
                node.name(), i, v[0], v[1], v[2]));
        }
        assign(arrays.position[first_vertex + i], baked, geometry_version_);
    }

    set_flag(arrays.has_normals[slot], !mesh.normals().empty(), with_normals_, surface_version_);
    if (with_normals_ > 0) {
        arrays.normal.resize(arrays.position.size(), Eigen::Vector3f::Zero());
        const Eigen::Matrix3d transform = normal_transform(linear);
        write_vectors(
            arrays.normal.begin() + first_vertex, arrays.vertex_count[slot], mesh.normals(),
            [&](const Eigen::Vector3d &normal) {
                return Eigen::Vector3f((transform * normal).stableNormalized().cast<float>());
            },
            Eigen::Vector3f::Zero(), surface_version_);
    }
    set_flag(arrays.has_uv[slot], !mesh.uvs().empty(), with_uv_, surface_version_);
    if (with_uv_ > 0) {
        arrays.uv.resize(arrays.position.size(), Eigen::Vector2f::Zero());
        write_vectors(
            arrays.uv.begin() + first_vertex, arrays.vertex_count[slot], mesh.uvs(),
            [](const Eigen::Vector2d &uv) { return Eigen::Vector2f(uv.cast<float>()); },
            Eigen::Vector2f::Zero(), surface_version_);
    }
    set_flag(arrays.has_colour[slot], !mesh.colours().empty(), with_colours_, surface_version_);
    if (with_colours_ > 0) {
        arrays.colour.resize(arrays.position.size(), Rgb::Ones());
        write_vectors(
            arrays.colour.begin() + first_vertex, arrays.vertex_count[slot], mesh.colours(),
            [](const Eigen::Vector3d &colour) { return Rgb(colour.cast<float>()); }, Rgb::Ones(),
            surface_version_);
    }

    const bool mirrors = linear.determinant() < 0;
    for (size_t i = 0; i < mesh.triangles().size(); ++i) {
        const Triangle &t = mesh.triangles()[i];
        assign(arrays.triangle[arrays.first_triangle[slot] + i],
               {first_vertex + t[0], first_vertex + t[mirrors ? 2 : 1],
                first_vertex + t[mirrors ? 1 : 2]},
               geometry_version_);
    }
}

void MeshStore::drop_unused() {
    if (with_normals_ == 0) {
        arrays.normal.clear();
    }
    if (with_uv_ == 0) {
        arrays.uv.clear();
    }
    if (with_colours_ == 0) {
        arrays.colour.clear();
    }
}

void MeshStore::keep(const std::vector<uint32_t> &slots) {
    ++geometry_version_;
    ++surface_version_;
    uint32_t vertices = 0;
    uint32_t triangles = 0;
    for (uint32_t mesh = 0; mesh < slots.size(); ++mesh) {
        const uint32_t old = slots[mesh];
        const uint32_t moved_by = arrays.first_vertex[old] - vertices;
        move_range(arrays.position, vertices, arrays.first_vertex[old], arrays.vertex_count[old]);
        move_range(arrays.normal, vertices, arrays.first_vertex[old], arrays.vertex_count[old]);
        move_range(arrays.uv, vertices, arrays.first_vertex[old], arrays.vertex_count[old]);
        move_range(arrays.colour, vertices, arrays.first_vertex[old], arrays.vertex_count[old]);
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
    arrays.normal.resize(arrays.normal.empty() ? 0 : vertices);
    arrays.uv.resize(arrays.uv.empty() ? 0 : vertices);
    arrays.colour.resize(arrays.colour.empty() ? 0 : vertices);
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
    keep_elements(arrays.has_colour, slots);
    with_normals_ =
        static_cast<size_t>(std::count(arrays.has_normals.begin(), arrays.has_normals.end(), 1));
    with_uv_ = static_cast<size_t>(std::count(arrays.has_uv.begin(), arrays.has_uv.end(), 1));
    with_colours_ =
        static_cast<size_t>(std::count(arrays.has_colour.begin(), arrays.has_colour.end(), 1));
}

}  // namespace rtrays
