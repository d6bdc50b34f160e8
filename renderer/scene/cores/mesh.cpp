// SPDX-License-Identifier: MIT
#include "renderer/scene/cores/mesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>

#include "renderer/base/error.h"

namespace rtrays {

namespace {

/// Largest texture coordinate. Beyond it a float would have no useful fraction.
constexpr double largest_uv = 1e6;

template <typename Vector, typename Legal>
void check_each(const std::vector<Vector> &vectors, const Legal &legal, const std::string &mesh,
                const char *what, const char *wrong) {
    for (size_t i = 0; i < vectors.size(); ++i) {
        if (!legal(vectors[i])) {
            throw input_error(fmt::format(
                "mesh '{}': {} {} {}: [{}]", mesh, what, i, wrong,
                fmt::join(vectors[i].data(), vectors[i].data() + vectors[i].size(), ", ")));
        }
    }
}

void check_count(size_t count, size_t vertices, const std::string &mesh, const char *what) {
    if (count != 0 && count != vertices) {
        throw input_error(
            fmt::format("mesh '{}': {} {} for {} vertices; give one per vertex, or none", mesh,
                        count, what, vertices));
    }
}

}  // namespace

MeshCore::MeshCore(std::string name, Geometry geometry) : Core(std::move(name)) {
    set_geometry(std::move(geometry));
}

MeshCore::MeshCore(std::string name, std::vector<Eigen::Vector3d> vertices,
                   std::vector<Triangle> triangles)
    : MeshCore(std::move(name), Geometry{std::move(vertices), std::move(triangles)}) {}

void MeshCore::set_geometry(Geometry geometry) {
    const size_t vertices = geometry.vertices.size();
    if (geometry.triangles.empty()) {
        throw input_error(fmt::format("mesh '{}' has no triangles", name()));
    }
    const auto finite = [](const auto &v) { return v.allFinite(); };
    check_each(geometry.vertices, finite, name(), "vertex", "is not finite");
    for (size_t i = 0; i < geometry.triangles.size(); ++i) {
        for (const uint32_t index : geometry.triangles[i]) {
            if (index >= vertices) {
                throw input_error(fmt::format(
                    "mesh '{}': triangle {} refers to vertex {}, but there are only {} vertices",
                    name(), i, index, vertices));
            }
        }
    }
    check_count(geometry.normals.size(), vertices, name(), "normals");
    check_count(geometry.uvs.size(), vertices, name(), "texture coordinates");
    check_count(geometry.colours.size(), vertices, name(), "colours");
    check_each(
        geometry.normals,
        [](const Eigen::Vector3d &n) { return n.allFinite() && n.stableNorm() > 0; }, name(),
        "normal", "has no direction");
    check_each(
        geometry.uvs,
        [](const Eigen::Vector2d &uv) {
            return uv.cwiseAbs().maxCoeff() <= largest_uv && uv.allFinite();
        },
        name(), "texture coordinate", "is not within +-1e6");
    check_each(
        geometry.colours,
        [](const Eigen::Vector3d &c) {
            return c.allFinite() && c.minCoeff() >= 0 && c.maxCoeff() <= 1;
        },
        name(), "colour", "is not within [0, 1]");
    for (Eigen::Vector3d &normal : geometry.normals) {
        normal.stableNormalize();
    }
    geometry_ = std::move(geometry);
    changed(Dirty::object);
}

void MeshCore::set_vertices(std::vector<Eigen::Vector3d> vertices,
                            std::vector<Eigen::Vector3d> normals) {
    geometry_.vertices = std::move(vertices);
    geometry_.normals = std::move(normals);
    changed(Dirty::object);
}

std::vector<Property> MeshCore::properties() {
    return {make_property<double>("vertices", "number of vertices",
                                  [this] { return static_cast<double>(vertices().size()); }),
            make_property<double>("triangles", "number of triangles",
                                  [this] { return static_cast<double>(triangles().size()); })};
}

MeshCore::Geometry rectangle() {
    return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
            {{0, 1, 2}, {0, 2, 3}},
            {},
            {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
}

MeshCore::Geometry box() {
    MeshCore::Geometry geometry;
    const MeshCore::Geometry side = rectangle();
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            // The side z = 1 in a frame whose axes are permuted cyclically. The opposite side is
            // turned by half a turn about the next axis.
            const auto first = static_cast<uint32_t>(geometry.vertices.size());
            for (const Eigen::Vector3d &corner : side.vertices) {
                Eigen::Vector3d vertex;
                vertex[axis] = sign;
                vertex[(axis + 1) % 3] = sign * corner.x();
                vertex[(axis + 2) % 3] = corner.y();
                geometry.vertices.push_back(vertex);
            }
            for (const Triangle &t : side.triangles) {
                geometry.triangles.push_back({first + t[0], first + t[1], first + t[2]});
            }
            geometry.uvs.insert(geometry.uvs.end(), side.uvs.begin(), side.uvs.end());
        }
    }
    return geometry;
}

}  // namespace rtrays
