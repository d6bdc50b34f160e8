// SPDX-License-Identifier: MIT
// Tests tessellation: the triangles are on the quadric that they replace, face its front, and have
// its area and texture coordinates.
#include "renderer/scene/stores/tessellation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "renderer/base/angles.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Kind = ShapeArrays::Kind;

constexpr double flare = 0.7;
constexpr TessellationGrid grids[] = {{256, 512}, {32, 64}};

MeshArrays triangles_of(Kind kind, const TessellationGrid &grid = {},
                        const Matrix4d &world = Matrix4d::Identity()) {
    ShapeArrays shapes;
    shapes.name = {"shape"};
    shapes.kind = {kind};
    shapes.world_from_object = {world};
    shapes.material = {3};
    shapes.light = {no_index};
    shapes.flare = {flare};
    return tessellated(shapes, 0, grid);
}

Vector3d corner(const MeshArrays &mesh, const Triangle &triangle, size_t i) {
    return mesh.position[triangle[i]].cast<double>();
}

Vector3d twice_area(const MeshArrays &mesh, const Triangle &triangle) {
    const Vector3d a = corner(mesh, triangle, 0);
    return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
}

/// Returns x^2 + y^2 as a function of z for each shape, as defined in stores.h.
const std::map<Kind, std::function<double(double)>> &profiles() {
    static const std::map<Kind, std::function<double(double)>> all = {
        {Kind::sphere, [](double z) { return 1 - z * z; }},
        {Kind::cylinder, [](double) { return 1.0; }},
        {Kind::cone, [](double z) { return (1 - z) * (1 - z); }},
        {Kind::paraboloid, [](double z) { return z; }},
        {Kind::hyperboloid, [](double z) { return 1 + flare * z * z; }},
    };
    return all;
}

TEST(Tessellation, PointsLieOnTheSurface) {
    for (const auto &[kind, profile] : profiles()) {
        const MeshArrays mesh = triangles_of(kind);
        for (const Eigen::Vector3f &position : mesh.position) {
            const Vector3d p = position.cast<double>();
            ASSERT_NEAR(p.x() * p.x() + p.y() * p.y(), profile(p.z()), 1e-4)
                << static_cast<int>(kind);
        }
    }
}

TEST(Tessellation, NormalsAreThoseOfTheTriangles) {
    for (const Kind kind : {Kind::sphere, Kind::cylinder, Kind::cone, Kind::paraboloid,
                            Kind::hyperboloid, Kind::disc}) {
        for (const TessellationGrid &grid : grids) {
            const MeshArrays mesh = triangles_of(kind, grid);
            ASSERT_EQ(mesh.triangle.size(), mesh.triangle_count[0]);
            for (const Triangle &triangle : mesh.triangle) {
                Vector3d normal = Vector3d::Zero();
                for (const uint32_t vertex : triangle) {
                    ASSERT_NEAR(mesh.normal[vertex].norm(), 1, 2e-7);
                    normal += mesh.normal[vertex].cast<double>() / 3;
                }
                // Normals deviate most for the two triangles at the tip of a paraboloid. The tip of
                // a cone has no normal.
                ASSERT_GT(twice_area(mesh, triangle).normalized().dot(normal), 0.99)
                    << static_cast<int>(kind);
            }
        }
    }
}

TEST(Tessellation, Areas) {
    const std::map<Kind, double> areas = {{Kind::sphere, 4 * pi},
                                          {Kind::disc, pi},
                                          {Kind::cylinder, 2 * pi},
                                          {Kind::cone, std::sqrt(2.0) * pi},
                                          {Kind::paraboloid, pi / 6 * (std::pow(5, 1.5) - 1)}};
    for (const auto &[kind, expected] : areas) {
        const MeshArrays mesh = triangles_of(kind);
        double area = 0;
        for (const Triangle &triangle : mesh.triangle) {
            area += 0.5 * twice_area(mesh, triangle).norm();
        }
        EXPECT_NEAR(area / expected, 1, 5e-5) << static_cast<int>(kind);
    }
}

TEST(Tessellation, Coordinates) {
    const MeshArrays sphere = triangles_of(Kind::sphere);
    for (size_t i = 0; i < sphere.position.size(); ++i) {
        const Vector3d p = sphere.position[i].cast<double>().normalized();
        EXPECT_NEAR(sphere.uv[i].y(), 1 - std::acos(std::clamp(p.z(), -1.0, 1.0)) / pi, 1e-6);
        if (std::abs(p.z()) < 0.999) {
            const double turns =
                std::atan2(p.y(), p.x()) / (2 * pi) - static_cast<double>(sphere.uv[i].x());
            EXPECT_NEAR(turns, std::round(turns), 1e-6);  // u is 1 at the end of the seam
        }
    }
    const MeshArrays disc = triangles_of(Kind::disc);
    for (size_t i = 0; i < disc.position.size(); ++i) {
        EXPECT_NEAR(disc.uv[i].x(), (disc.position[i].x() + 1) / 2, 2e-5);
        EXPECT_NEAR(disc.uv[i].y(), (disc.position[i].y() + 1) / 2, 2e-5);
    }
}

TEST(Tessellation, AMirrorKeepsTheFront) {
    for (const double x : {2.0, -2.0}) {
        Matrix4d world = Vector3d(x, 1, 1).homogeneous().asDiagonal();
        const Vector3d centre(5, 6, 7);
        world.topRightCorner<3, 1>() = centre;
        const MeshArrays mesh = triangles_of(Kind::sphere, {}, world);
        for (const Triangle &triangle : mesh.triangle) {
            ASSERT_GT(twice_area(mesh, triangle).dot(corner(mesh, triangle, 0) - centre), 0);
        }
        for (size_t i = 0; i < mesh.position.size(); ++i) {
            ASSERT_GT(mesh.normal[i].cast<double>().dot(mesh.position[i].cast<double>() - centre),
                      0);
        }
    }
}

TEST(Tessellation, PlanesAndJuliaSetsHaveNone) {
    for (const Kind kind : {Kind::plane, Kind::julia}) {
        EXPECT_FALSE(can_be_tessellated(kind));
        EXPECT_THROW(triangles_of(kind), Error);
    }
}

}  // namespace
}  // namespace rtrays
