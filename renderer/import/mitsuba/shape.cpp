// SPDX-License-Identifier: MIT
// Conversion of shapes to geometry. Parameters, defaults and parametrisations are those of
// Mitsuba 3.9, src/shapes/*.cpp.
#include "renderer/import/mitsuba/shape.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "renderer/import/models/geometry.h"
#include "renderer/import/models/model_file.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/shape.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/stores/pose.h"

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

/// Returns the transform of a shape that must stay round. Throws if it does not. Mitsuba warns and
/// continues with one of the radii.
Matrix4d round_transform(Object &object) {
    const Matrix4d to_world = object.transform();
    return object.element().located(
        [&] { return nearest_similarity(to_world, "a " + object.type()); });
}

double radius_of(Object &object) {
    const double radius = object.number("radius", 1);
    if (!(radius > 0)) {
        throw object.property("radius").error(fmt::format("{} is not positive", radius));
    }
    return radius;
}

/// Returns the frame (columns s, t, n) that Mitsuba builds around a unit vector (Duff et al. 2017,
/// "Building an orthonormal basis, revisited"). It sets where the texture of a cylinder begins.
Eigen::Matrix3d frame_around(const Vector3d &n) {
    const double sign = std::copysign(1.0, n.z());
    const double a = -1 / (sign + n.z());  // |sign + z| >= 1
    const double b = n.x() * n.y() * a;
    Eigen::Matrix3d frame;
    frame.col(0) = Vector3d(sign * n.x() * n.x() * a + 1, sign * b, -sign * n.x());
    frame.col(1) = Vector3d(b, n.y() * n.y() * a + sign, -n.y());
    frame.col(2) = n;
    return frame;
}

MeshCore::Geometry geometry_of(const std::filesystem::path &path, bool without_normals) {
    MeshFileOptions options;
    options.normals =
        without_normals ? MeshFileOptions::Normals::none : MeshFileOptions::Normals::stored;
    const std::shared_ptr<MeshCore> mesh = load_mesh_file(path, path.stem().string(), options);
    return {mesh->vertices(), mesh->triangles(), mesh->normals(), mesh->uvs()};
}

}  // namespace

const std::vector<ShapeReader::Type> &ShapeReader::types() {
    static const std::vector<Type> all = {
        {"obj", &ShapeReader::read_file},
        {"ply", &ShapeReader::read_file},
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
    const Matrix4d to_world = round_transform(object);
    const Vector3d center = object.vector("center").value_or(Vector3d::Zero());
    Shape shape{core,
                to_world * translation(center) * scaling(Vector3d::Constant(radius_of(object))),
                UvConvention::flipped};
    shape.is_flipped = object.boolean("flip_normals", false);
    return shape;
}

Shape ShapeReader::read_disk(Object &object) {
    std::shared_ptr<Core> &core = shared("disk");
    if (core == nullptr) {
        core = std::make_shared<ShapeCore>("disk", "disc", ParameterValues{});
    }
    Shape shape{core, object.transform()};
    if (object.boolean("flip_normals", false)) {
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
    const Matrix4d to_world = round_transform(object);
    const Vector3d p0 = object.vector("p0").value_or(Vector3d::Zero());
    const Vector3d p1 = object.vector("p1").value_or(Vector3d::UnitZ());
    const double length = (p1 - p0).stableNorm();
    if (!(length > 0)) {
        throw object.element().error("p0 and p1 must be different points");
    }
    const double radius = radius_of(object);
    Matrix4d frame = Matrix4d::Identity();
    frame.topLeftCorner<3, 3>() = frame_around((p1 - p0) / length);
    Shape shape{core, to_world * translation(p0) * frame * scaling({radius, radius, length}),
                UvConvention::same};
    shape.can_emit = false;
    shape.is_flipped = object.boolean("flip_normals", false);
    return shape;
}

Shape ShapeReader::read_file(Object &object) {
    const bool is_obj = object.type() == "obj";
    const std::optional<std::string> file = object.text("filename");
    if (!file.has_value()) {
        throw object.element().error("needs a filename");
    }
    const Matrix4d to_world = object.transform();
    const bool face_normals = object.boolean("face_normals", false);
    const bool flip_normals = object.boolean("flip_normals", false);
    const bool flip_v = object.boolean("flip_tex_coords", is_obj);
    const std::filesystem::path path = object.element().path(*file);

    // Normals in the file are transformed. If there are none, Mitsuba computes them from the
    // triangles in world space. The result is the same in object space if the transform is a
    // similarity that does not mirror.
    const bool is_plain =
        similarity_scale(to_world) > 0 && to_world.topLeftCorner<3, 3>().determinant() > 0;
    const std::string key =
        fmt::format("{} {} {}", face_normals, flip_normals, path.lexically_normal().string());
    std::shared_ptr<Core> core = is_plain ? shared_[key] : nullptr;
    Matrix4d world_from_geometry = to_world;
    if (core == nullptr) {
        MeshCore::Geometry geometry = geometry_of(path, face_normals);
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
