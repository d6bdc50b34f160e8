// SPDX-License-Identifier: MIT
// Conversion of shapes to geometry. Parameters, defaults and parametrisations are those of
// Mitsuba 3.9, src/shapes/*.cpp.
#include "renderer/import/mitsuba/shape.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "renderer/base/angles.h"
#include "renderer/base/notice.h"
#include "renderer/import/mitsuba/serialized.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/model_file.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/shape.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/stores/pose.h"
#include "renderer/scene/stores/tessellation.h"

namespace rtrays::mitsuba {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

/// Returns the geometry with front and back exchanged.
MeshCore::Geometry turned(MeshCore::Geometry geometry) {
    for (Triangle &t : geometry.triangles) {
        std::swap(t[1], t[2]);
    }
    for (Vector3d &normal : geometry.normals) {
        normal = -normal;
    }
    return geometry;
}

/// Returns the cube -1 <= x, y, z <= 1 with Mitsuba's texture coordinates.
MeshCore::Geometry cube() {
    // The corners of each side at (u, v) = (0, 1), (1, 1), (1, 0), (0, 0).
    constexpr double corners[6][4][3] = {
        {{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}},
        {{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}},
        {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},
        {{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}},
        {{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}},
        {{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}},
    };
    MeshCore::Geometry geometry;
    for (const auto &side : corners) {
        const auto first = static_cast<uint32_t>(geometry.vertices.size());
        for (const auto &corner : side) {
            geometry.vertices.emplace_back(corner[0], corner[1], corner[2]);
        }
        geometry.uvs.insert(geometry.uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
        geometry.triangles.push_back({first, first + 1, first + 2});
        geometry.triangles.push_back({first + 3, first, first + 2});
    }
    return geometry;
}

/// Returns the disk of radius 1 around the origin in the plane z = 0, which faces +z, with
/// Mitsuba's texture coordinates: the radius, and the angle about +z from +x divided by 2 pi. Its
/// edge is within 3e-4 of the circle.
MeshCore::Geometry polar_disk() {
    constexpr uint32_t rings = 16, sectors = 128, row = sectors + 1;
    MeshCore::Geometry geometry;
    for (uint32_t ring = 0; ring <= rings; ++ring) {
        for (uint32_t sector = 0; sector <= sectors; ++sector) {
            const double radius = static_cast<double>(ring) / rings;
            const double turn = static_cast<double>(sector) / sectors;
            geometry.vertices.emplace_back(radius * std::cos(2 * pi * turn),
                                           radius * std::sin(2 * pi * turn), 0);
            // The corner of a sector at the centre has the angle of its middle.
            geometry.uvs.emplace_back(radius, ring == 0 ? turn + 0.5 / sectors : turn);
        }
    }
    for (uint32_t ring = 0; ring < rings; ++ring) {
        for (uint32_t sector = 0; sector < sectors; ++sector) {
            const uint32_t inner = ring * row + sector, outer = inner + row;
            geometry.triangles.push_back({inner, outer, outer + 1});
            if (ring > 0) {
                geometry.triangles.push_back({inner, outer + 1, inner + 1});
            }
        }
    }
    return geometry;
}

/// Returns the transform of a cylinder along z, whose radius must stay the same around the axis.
/// The scale along the axis may differ.
Matrix4d round_transform(const Object &object, const Matrix4d &world) {
    const Eigen::Array3d scales = world.topLeftCorner<3, 3>().colwise().stableNorm();
    Matrix4d similarity = world;
    similarity.col(2) *= scales[0] / scales[2];
    const bool is_round = std::abs(scales[1] / scales[0] - 1) < 1e-4;
    Matrix4d result = object.element().located(
        [&] { return nearest_similarity(is_round ? similarity : world, "a " + object.type()); });
    result.col(2) *= scales[2] / scales[0];
    return result;
}

double radius_of(Object &object) {
    const double radius = object.number("radius", 1);
    if (!(radius > 0)) {
        throw object.property("radius").error(fmt::format("{} is not positive", radius));
    }
    return radius;
}

MeshCore::Geometry geometry_of(const std::filesystem::path &path, bool without_normals) {
    MeshFileOptions options;
    options.normals =
        without_normals ? MeshFileOptions::Normals::none : MeshFileOptions::Normals::stored;
    const std::shared_ptr<MeshCore> mesh = load_mesh_file(path, path.stem().string(), options);
    MeshCore::Geometry geometry = mesh->geometry();
    turn_towards_normals(geometry);
    return geometry;
}

}  // namespace

void turn_towards_normals(MeshCore::Geometry &geometry) {
    if (geometry.normals.empty()) {
        return;
    }
    for (Triangle &t : geometry.triangles) {
        const Vector3d &a = geometry.vertices[t[0]];
        const Vector3d front = (geometry.vertices[t[1]] - a).cross(geometry.vertices[t[2]] - a);
        const Vector3d stored =
            geometry.normals[t[0]] + geometry.normals[t[1]] + geometry.normals[t[2]];
        if (front.dot(stored) < 0) {
            std::swap(t[1], t[2]);
        }
    }
}

Shape tessellated(const Shape &shape) {
    const auto &core = static_cast<const ShapeCore &>(*shape.geometry);
    ShapeArrays arrays;
    arrays.name = {core.name()};
    arrays.kind = {core.kind()};
    arrays.world_from_object = {core.object_from_canonical()};
    arrays.material = {0};
    arrays.light = {no_index};
    arrays.flare = {1};
    // A chord is below its arc by 3e-4 of the radius of a sphere, and by 8e-5 of a cylinder's.
    const bool is_cylinder = core.kind() == ShapeArrays::Kind::cylinder;
    const MeshArrays mesh = rtrays::tessellated(
        arrays, 0, is_cylinder ? TessellationGrid{1, 256} : TessellationGrid{64, 128});
    MeshCore::Geometry geometry;
    geometry.triangles = mesh.triangle;
    for (size_t i = 0; i < mesh.position.size(); ++i) {
        geometry.vertices.push_back(mesh.position[i].cast<double>());
        geometry.normals.push_back(mesh.normal[i].cast<double>());
        geometry.uvs.push_back(mesh.uv[i].cast<double>());
    }
    Shape result = shape;
    result.geometry = std::make_shared<MeshCore>(
        core.name(), shape.is_flipped ? turned(std::move(geometry)) : std::move(geometry));
    result.can_emit = true;
    result.is_flipped = false;
    return result;
}

const std::vector<ShapeReader::Type> &ShapeReader::types() {
    static const std::vector<Type> all = {
        {"obj", &ShapeReader::read_file},
        {"ply", &ShapeReader::read_file},
        {"serialized", &ShapeReader::read_serialized_mesh},
        {"rectangle", &ShapeReader::read_rectangle},
        {"cube", &ShapeReader::read_cube},
        {"sphere", &ShapeReader::read_sphere},
        {"disk", &ShapeReader::read_disk},
        {"cylinder", &ShapeReader::read_cylinder},
    };
    return all;
}

Shape ShapeReader::read(Object &object) {
    std::string names;
    for (const Type &type : types()) {
        if (object.type() == type.name) {
            return object.element().located([&] { return (this->*type.read)(object); });
        }
        names += (names.empty() ? "" : ", ") + std::string(type.name);
    }
    throw object.element().error(
        fmt::format("unsupported shape type; supported types are: {}", names));
}

Shape ShapeReader::read_rectangle(Object &object) {
    const bool flip = object.boolean("flip_normals", false);
    std::shared_ptr<Core> &core = shared(flip ? "rectangle_flipped" : "rectangle");
    if (core == nullptr) {
        core = std::make_shared<MeshCore>("rectangle", flip ? turned(rectangle()) : rectangle());
    }
    return {core, object.transform(), UvConvention::same};
}

Shape ShapeReader::read_cube(Object &object) {
    const bool flip = object.boolean("flip_normals", false);
    std::shared_ptr<Core> &core = shared(flip ? "cube_flipped" : "cube");
    if (core == nullptr) {
        core = std::make_shared<MeshCore>("cube", flip ? turned(cube()) : cube());
    }
    return {core, object.transform(), UvConvention::same};
}

Shape ShapeReader::read_sphere(Object &object) {
    std::shared_ptr<Core> &core = shared("sphere");
    if (core == nullptr) {
        core = std::make_shared<ShapeCore>("sphere", "sphere", ParameterValues{});
    }
    // Mitsuba warns of a stretched sphere and continues with one of its radii.
    const Matrix4d to_world = object.element().located(
        [&] { return nearest_similarity(object.transform(), "a sphere"); });
    const Vector3d center = object.vector("center").value_or(Vector3d::Zero());
    Shape shape{core,
                to_world * translation(center) * scaling(Vector3d::Constant(radius_of(object))),
                UvConvention::flipped};
    // Mitsuba's spheres, and no other shapes, exchange their sides where the transform mirrors.
    const bool mirrors = to_world.topLeftCorner<3, 3>().determinant() < 0;
    shape.is_flipped = object.boolean("flip_normals", false) != mirrors;
    return shape;
}

Shape ShapeReader::read_disk(Object &object) {
    const bool flip = object.boolean("flip_normals", false);
    if (object.shows_texture()) {
        std::shared_ptr<Core> &core = shared(flip ? "polar_disk_flipped" : "polar_disk");
        if (core == nullptr) {
            core = std::make_shared<MeshCore>("disk", flip ? turned(polar_disk()) : polar_disk());
        }
        notice(object.element()
                   .error(fmt::format("replaced by a mesh of {} triangles, because the texture "
                                      "coordinates of this shape are polar",
                                      static_cast<const MeshCore &>(*core).triangles().size()))
                   .what());
        return {core, object.transform(), UvConvention::same};
    }
    std::shared_ptr<Core> &core = shared("disk");
    if (core == nullptr) {
        core = std::make_shared<ShapeCore>("disk", "disc", ParameterValues{});
    }
    Shape shape{core, object.transform()};
    if (flip) {
        shape.world_from_geometry *= scaling({1, -1, -1});  // rotation by 180 degrees about x
    }
    return shape;
}

Shape ShapeReader::read_cylinder(Object &object) {
    std::shared_ptr<Core> &core = shared("cylinder");
    if (core == nullptr) {
        core = std::make_shared<ShapeCore>("cylinder", "cylinder",
                                           ParameterValues{{"radius", 1.0}, {"height", 1.0}});
    }
    const Matrix4d to_world = object.transform();
    const Vector3d p0 = object.vector("p0").value_or(Vector3d::Zero());
    const Vector3d p1 = object.vector("p1").value_or(Vector3d::UnitZ());
    const double length = (p1 - p0).stableNorm();
    if (!(length > 0)) {
        throw object.element().error("p0 and p1 must be different points");
    }
    const double radius = radius_of(object);
    Matrix4d frame = Matrix4d::Identity();
    frame.topLeftCorner<3, 3>() = frame_around((p1 - p0) / length);
    const Matrix4d world = to_world * translation(p0) * frame * scaling({radius, radius, length});
    Shape shape{core, round_transform(object, world), UvConvention::same};
    shape.can_emit = false;
    shape.is_flipped = object.boolean("flip_normals", false);
    return shape;
}

namespace {

std::filesystem::path file_of(Object &object) {
    const std::optional<std::string> file = object.text("filename");
    if (!file.has_value()) {
        throw object.element().error("needs a filename");
    }
    return object.element().path(*file);
}

}  // namespace

Shape ShapeReader::read_file(Object &object) {
    const bool flip_v = object.boolean("flip_tex_coords", object.type() == "obj");
    const std::filesystem::path path = file_of(object);
    return mesh(object, path, "", flip_v,
                [&](bool without_normals) { return geometry_of(path, without_normals); });
}

Shape ShapeReader::read_serialized_mesh(Object &object) {
    const std::filesystem::path path = file_of(object);
    const double index = object.number("shape_index", 0);
    if (!(index >= 0 && index < no_index) || index != std::floor(index)) {
        throw object.property("shape_index")
            .error(fmt::format("expected an integer from 0, got {}", index));
    }
    const std::string key = fmt::format("{} ", index);
    return mesh(object, path, key, false, [&](bool without_normals) {
        MeshCore::Geometry geometry = read_serialized(path, static_cast<size_t>(index));
        if (without_normals) {
            geometry.normals.clear();
        }
        turn_towards_normals(geometry);
        return geometry;
    });
}

Shape ShapeReader::mesh(Object &object, const std::filesystem::path &path,
                        const std::string &prefix, bool flip_v,
                        const std::function<MeshCore::Geometry(bool without_normals)> &load) {
    const Matrix4d to_world = object.transform();
    const bool face_normals = object.boolean("face_normals", false);
    const bool flip_normals = object.boolean("flip_normals", false);
    // Normals in the file are transformed. If there are none, Mitsuba computes them from the
    // triangles in world space. The result is the same in object space if the transform is a
    // similarity that does not mirror.
    const bool is_plain =
        similarity_scale(to_world) > 0 && to_world.topLeftCorner<3, 3>().determinant() > 0;
    const std::string key = fmt::format("{}{} {} {}", prefix, face_normals, flip_normals,
                                        path.lexically_normal().string());
    std::shared_ptr<Core> core = is_plain ? shared_[key] : nullptr;
    Matrix4d world_from_geometry = to_world;
    if (core == nullptr) {
        MeshCore::Geometry geometry = load(face_normals);
        if (geometry.normals.empty()) {
            if (!is_plain) {
                for (Vector3d &vertex : geometry.vertices) {
                    vertex = (to_world * vertex.homogeneous()).head<3>();
                }
                world_from_geometry.setIdentity();
            }
            if (!face_normals) {
                make_smooth_normals(geometry);
            }
        }
        core = std::make_shared<MeshCore>(
            path.stem().string(), flip_normals ? turned(std::move(geometry)) : std::move(geometry));
        if (is_plain) {
            shared_[key] = core;
        }
    }
    const bool has_uv = !static_cast<const MeshCore &>(*core).uvs().empty();
    return {core, world_from_geometry,
            !has_uv  ? UvConvention::none
            : flip_v ? UvConvention::flipped
                     : UvConvention::same};
}

}  // namespace rtrays::mitsuba
