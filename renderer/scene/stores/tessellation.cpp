// SPDX-License-Identifier: MIT
#include "renderer/scene/stores/tessellation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/base/angles.h"
#include "renderer/base/error.h"

namespace rtrays {

namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Vertex {
    Vector3d position, normal;  ///< the normal can have any length
    double v;                   ///< texture coordinate
};

/// A canonical surface of stores.h, parametrised from its first row (t = 0) to its last (t = 1).
struct Quadric {
    ShapeArrays::Kind kind;
    Vertex (*at)(double phi, double t, double flare);
    bool first_is_pole, last_is_pole;
    double area;   ///< area that the triangles are scaled to; 0 for no scaling
    bool is_flat;  ///< one row is sufficient
};

/// Returns a vertex of a surface of revolution. Its normal is (cos phi, sin phi) times `outwards`,
/// and `upwards` along z.
Vertex of_revolution(double phi, double radius, double z, double outwards, double upwards,
                     double v) {
    const double cosine = std::cos(phi), sine = std::sin(phi);
    return {{radius * cosine, radius * sine, z}, {outwards * cosine, outwards * sine, upwards}, v};
}

Vertex on_sphere(double phi, double t, double /*flare*/) {
    const double theta = pi * (1 - t);
    return of_revolution(phi, std::sin(theta), std::cos(theta), std::sin(theta), std::cos(theta),
                         t);
}

Vertex on_cylinder(double phi, double t, double /*flare*/) {
    return of_revolution(phi, 1, t, 1, 0, t);
}

Vertex on_cone(double phi, double t, double /*flare*/) {
    return of_revolution(phi, 1 - t, t, 1, 1, t);
}

/// Rows have equal steps in the radius r; z = r^2. The gradient of x^2 + y^2 - z is (2 x, 2 y, -1).
Vertex on_paraboloid(double phi, double t, double /*flare*/) {
    return of_revolution(phi, t, t * t, 2 * t, -1, t * t);
}

/// The normal is half the gradient of x^2 + y^2 - 1 - flare z^2.
Vertex on_hyperboloid(double phi, double t, double flare) {
    const double z = 2 * t - 1, radius = std::sqrt(1 + flare * z * z);
    return of_revolution(phi, radius, z, radius, -flare * z, t);
}

Vertex on_disc(double phi, double t, double /*flare*/) {
    return of_revolution(phi, t, 0, 0, 1, 0);
}

constexpr Quadric quadrics[] = {
    {ShapeArrays::Kind::sphere, on_sphere, true, true, 4 * pi, false},
    {ShapeArrays::Kind::cylinder, on_cylinder, false, false, 0, false},
    {ShapeArrays::Kind::cone, on_cone, false, true, 0, false},
    {ShapeArrays::Kind::paraboloid, on_paraboloid, true, false, 0, false},
    {ShapeArrays::Kind::hyperboloid, on_hyperboloid, false, false, 0, false},
    {ShapeArrays::Kind::disc, on_disc, false, false, pi, true},
};

const Quadric *quadric_of(ShapeArrays::Kind kind) {
    const auto *found = std::find_if(std::begin(quadrics), std::end(quadrics),
                                     [&](const Quadric &q) { return q.kind == kind; });
    return found == std::end(quadrics) ? nullptr : found;
}

/// Returns the normal of a triangle; its length is twice the area.
Vector3d twice_area(const std::vector<Vector3d> &position, const Triangle &triangle) {
    const Vector3d &a = position[triangle[0]];
    return (position[triangle[1]] - a).cross(position[triangle[2]] - a);
}

/// Returns two triangles per cell, counter-clockwise in the plane of u and v.
std::vector<Triangle> cells(uint32_t rows, uint32_t columns) {
    std::vector<Triangle> triangles;
    triangles.reserve(size_t{2} * rows * columns);
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t first = row * (columns + 1) + column, above = first + columns + 1;
            triangles.push_back({first, first + 1, above + 1});
            triangles.push_back({first, above + 1, above});
        }
    }
    return triangles;
}

}  // namespace

bool can_be_tessellated(ShapeArrays::Kind kind) {
    return quadric_of(kind) != nullptr;
}

MeshArrays tessellated(const ShapeArrays &shapes, uint32_t shape, const TessellationGrid &grid) {
    const Quadric *quadric = quadric_of(shapes.kind[shape]);
    if (quadric == nullptr) {
        throw run_error("'" + shapes.name[shape] + "': a shape of this kind cannot be tessellated");
    }
    const uint32_t rows = quadric->is_flat ? 1 : grid.rows, columns = grid.columns;
    std::vector<Vector3d> position, normal;
    MeshArrays mesh;
    for (uint32_t row = 0; row <= rows; ++row) {
        const bool is_pole =
            (row == 0 && quadric->first_is_pole) || (row == rows && quadric->last_is_pole);
        for (uint32_t column = 0; column <= columns; ++column) {
            const double u = static_cast<double>(column) / columns;
            const Vertex vertex =
                quadric->at(2 * pi * u, static_cast<double>(row) / rows, shapes.flare[shape]);
            position.push_back(vertex.position);
            normal.push_back(vertex.normal);
            // The u of a pole is that of the middle of the triangle that ends there.
            const Vector2d uv = quadric->is_flat
                                    ? Vector2d((vertex.position.head<2>().array() + 1) / 2)
                                    : Vector2d(is_pole ? (column + 0.5) / columns : u, vertex.v);
            mesh.uv.push_back(uv.cast<float>());
        }
    }

    mesh.triangle = cells(rows, columns);
    double area = 0;
    for (const Triangle &triangle : mesh.triangle) {
        area += 0.5 * twice_area(position, triangle).norm();
    }
    const double mean = area / static_cast<double>(mesh.triangle.size());
    // Triangles without area, at the poles, are removed.
    mesh.triangle.erase(
        std::remove_if(mesh.triangle.begin(), mesh.triangle.end(),
                       [&](const Triangle &triangle) {
                           return !(0.5 * twice_area(position, triangle).norm() > 1e-6 * mean);
                       }),
        mesh.triangle.end());

    const double scale = quadric->area > 0 ? std::sqrt(quadric->area / area) : 1;
    const Matrix4d &world = shapes.world_from_object[shape];
    const Matrix3d to_normal = world.topLeftCorner<3, 3>().inverse().transpose();
    for (size_t i = 0; i < position.size(); ++i) {
        position[i] = (world * (scale * position[i]).homogeneous()).head<3>();
        normal[i] = (to_normal * normal[i]).normalized();
        mesh.position.push_back(position[i].cast<float>());
        mesh.normal.push_back(normal[i].cast<float>());
    }
    double facing = 0;
    for (const Triangle &triangle : mesh.triangle) {
        facing += twice_area(position, triangle).dot(normal[triangle[0]]);
    }
    if (facing < 0) {
        for (Triangle &triangle : mesh.triangle) {
            std::swap(triangle[1], triangle[2]);
        }
    }

    mesh.name = {shapes.name[shape]};
    mesh.first_triangle = {0};
    mesh.triangle_count = {static_cast<uint32_t>(mesh.triangle.size())};
    mesh.first_vertex = {0};
    mesh.vertex_count = {static_cast<uint32_t>(position.size())};
    mesh.material = {shapes.material[shape]};
    mesh.light = {shapes.light[shape]};
    mesh.has_normals = {1};
    mesh.has_uv = {1};
    mesh.triangle_mesh.assign(mesh.triangle.size(), 0);
    return mesh;
}

}  // namespace rtrays
